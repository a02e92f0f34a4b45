#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

#include "scan_voxels.hpp"
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

TEST(ThinnedScan, HoldsTheFirstPointOfEachVoxelInRange) {
  constexpr double voxel_m = 0.2, range_m = 30;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(2.3, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX())).toRotationMatrix();
  T.translation() = Eigen::Vector3d(-1234.56, 3.21, -0.07);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> across(-35, 35), up(-2, 3);
  for (const std::size_t count : {0u, 1u, 511u, 512u, 513u, 40000u}) {
    for (const bool has_intensity : {false, true}) {
      PointCloud scan;
      for (std::size_t i = 0; i < count; ++i) {
        scan.xyz.emplace_back(across(random), across(random), up(random));
        if (i % 3 == 2) scan.xyz[i] = scan.xyz[i - 1];   // as neighbours on a ring
        if (has_intensity) scan.intensity.push_back(static_cast<float>(i));
      }
      std::set<std::tuple<double, double, double>> seen;
      PointCloud expected;
      const Eigen::Matrix3f R = T.linear().cast<float>();
      for (std::size_t i = 0; i < count; ++i) {
        if (scan.xyz[i].squaredNorm() > static_cast<float>(range_m * range_m)) continue;
        const Eigen::Vector3f p = R * scan.xyz[i];
        const Eigen::Vector3d voxel = ((T.translation() + p.cast<double>()) / voxel_m).array().floor();
        if (!seen.insert({voxel.x(), voxel.y(), voxel.z()}).second) continue;
        expected.xyz.push_back(p);
        if (has_intensity) expected.intensity.push_back(scan.intensity[i]);
      }
      const ThinnedScan thinned = thinned_in_map(scan, T, voxel_m, range_m);
      EXPECT_EQ(thinned.points.xyz, expected.xyz) << count;
      EXPECT_EQ(thinned.points.intensity, expected.intensity) << count;
      ASSERT_EQ(thinned.bits.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const std::uint32_t bit = thinned.bits[i] % 512;
        const Eigen::Vector3i in_block(static_cast<int>(bit % 8), static_cast<int>(bit / 8 % 8), static_cast<int>(bit / 64));
        const Eigen::Vector3d voxel = (8 * thinned.blocks[thinned.bits[i] / 512].key + in_block).cast<double>();
        ASSERT_EQ(seen.count({voxel.x(), voxel.y(), voxel.z()}), 1u) << i;
      }
    }
  }
}

}  // namespace
}  // namespace priormap
