#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

#include "voxel_occupancy.hpp"

namespace priormap {
namespace {

TEST(VoxelOccupancy, AgreesWithASet) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-30, 30);
  VoxelOccupancy occupied(0.5);
  std::set<std::tuple<int, int, int>> oracle;
  for (int i = 0; i < 100000; ++i) {
    const Eigen::Vector3d p(coordinate(random), coordinate(random), 0.2 * coordinate(random));
    const auto cell = [](double v) { return static_cast<int>(std::floor(v / 0.5)); };
    ASSERT_EQ(occupied.insert(p), oracle.insert({cell(p.x()), cell(p.y()), cell(p.z())}).second);
  }
}

TEST(VoxelOccupancy, ForgetsWhatIsFarAndOnlyThat) {
  VoxelOccupancy occupied(0.2);
  occupied.insert({1, 1, 0});
  occupied.insert({500, 1, 0});
  occupied.forget_beyond({0, 0, 0}, 100);
  EXPECT_FALSE(occupied.insert({1, 1, 0}));
  EXPECT_TRUE(occupied.insert({500, 1, 0}));
}

}  // namespace
}  // namespace priormap
