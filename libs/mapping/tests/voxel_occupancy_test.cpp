#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

#include "voxel_occupancy.hpp"

namespace priormap {
namespace {

TEST(VoxelOccupancy, AgreesWithASet) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> coordinate(-60, 60);
  VoxelOccupancy occupied;
  std::set<std::tuple<int, int, int>> oracle;
  for (int i = 0; i < 100000; ++i) {
    const Eigen::Vector3i voxel(coordinate(random), coordinate(random), coordinate(random) / 5);
    ASSERT_EQ(occupied.insert(voxel).was_free, oracle.insert({voxel.x(), voxel.y(), voxel.z()}).second);
  }
}

TEST(VoxelOccupancy, TellsWhichVoxelsOfABlockWereFree) {
  VoxelOccupancy all, some;
  all.insert({-8, 3, 17});
  some.insert({-8, 3, 17});
  const VoxelOccupancy::Place other = some.insert({-1, 4, 16});
  ASSERT_EQ(some.blocks().size(), 1u);
  const auto free = all.insert(some.blocks()[0]);
  for (std::size_t z = 0; z < 8; ++z) EXPECT_EQ(free[z], z == other.bit / 64u ? std::uint64_t{1} << other.bit % 64 : 0u);
  EXPECT_FALSE(all.insert({-1, 4, 16}).was_free);
}

TEST(VoxelOccupancy, ForgetsWhatIsFarAndOnlyThat) {
  VoxelOccupancy occupied;
  occupied.insert({5, 5, 0});
  occupied.insert({2500, 5, 0});
  occupied.forget_beyond({0, 0, 0}, 100, 0.2);
  EXPECT_FALSE(occupied.insert({5, 5, 0}).was_free);
  EXPECT_TRUE(occupied.insert({2500, 5, 0}).was_free);
}

}  // namespace
}  // namespace priormap
