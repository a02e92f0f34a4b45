#include <priormap/pointcloud/downsample.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <tuple>

namespace priormap {
namespace {

PointCloud random_cloud() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> within(-20, 20);
  PointCloud cloud;
  cloud.origin = {400000, 5000000, 100};
  for (int i = 0; i < 5000; ++i) cloud.xyz.push_back({within(random), within(random), within(random)});
  return cloud;
}

std::tuple<long, long, long> voxel(const Eigen::Vector3d& p, double size) {
  return {std::lround(std::floor(p.x() / size)), std::lround(std::floor(p.y() / size)), std::lround(std::floor(p.z() / size))};
}

TEST(VoxelDownsample, leaves_one_point_in_each_occupied_voxel) {
  const PointCloud cloud = random_cloud();
  std::set<std::tuple<long, long, long>> occupied, kept;
  for (std::size_t i = 0; i < cloud.size(); ++i) occupied.insert(voxel(cloud.position(i), 2.0));
  const PointCloud first = voxel_downsample_first(cloud, 2.0);
  for (std::size_t i = 0; i < first.size(); ++i) kept.insert(voxel(first.position(i), 2.0));
  EXPECT_EQ(first.size(), occupied.size());
  EXPECT_EQ(kept, occupied);
  EXPECT_EQ(voxel_downsample_centroid(cloud, 2.0).size(), occupied.size());
}

TEST(VoxelDownsample, keeps_the_first_point_of_a_voxel_and_its_columns) {
  PointCloud cloud;
  cloud.xyz = {{0.9f, 0.1f, 0.1f}, {0.2f, 0.1f, 0.1f}, {-0.1f, 0.1f, 0.1f}};
  cloud.intensity = {5, 6, 7};
  const PointCloud first = voxel_downsample_first(cloud, 1.0);
  EXPECT_EQ(first.intensity, (std::vector<float>{5, 7}));
}

TEST(VoxelDownsample, the_centroid_is_the_mean_of_the_voxels_points) {
  PointCloud cloud;
  cloud.xyz = {{0.25f, 0.5f, 0.5f}, {0.75f, 0.5f, 0.25f}};
  cloud.normal = {{0, 0, 1}, {1, 0, 0}};
  const PointCloud centroid = voxel_downsample_centroid(cloud, 1.0);
  ASSERT_EQ(centroid.size(), 1u);
  EXPECT_TRUE(centroid.xyz[0].isApprox(Eigen::Vector3f(0.5f, 0.5f, 0.375f)));
  EXPECT_NEAR(centroid.normal[0].norm(), 1, 1e-6);
}

TEST(VoxelDownsample, does_not_depend_on_the_origin) {
  PointCloud cloud = random_cloud();
  const std::size_t expected = voxel_downsample_first(cloud, 0.5).size();
  cloud.set_origin({400003.5, 5000001.25, 98});
  EXPECT_EQ(voxel_downsample_first(cloud, 0.5).size(), expected);
}

TEST(VoxelDownsample, leaves_out_points_that_are_no_numbers) {
  PointCloud cloud;
  cloud.xyz = {{0, 0, 0}, {std::numeric_limits<float>::quiet_NaN(), 0, 0}};
  EXPECT_EQ(voxel_downsample_first(cloud, 1.0).size(), 1u);
  EXPECT_TRUE(voxel_downsample_first(PointCloud{}, 1.0).empty());
}

}  // namespace
}  // namespace priormap
