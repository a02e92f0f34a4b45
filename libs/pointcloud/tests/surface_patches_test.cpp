#include <priormap/pointcloud/surface_patches.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace priormap {
namespace {

TEST(SurfacePatches, KeepTheMomentsOfThePoints) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> part(0, 1);
  PointCloud cloud;
  cloud.origin = {691'000, 5'336'000, 500};
  for (int i = 0; i < 500; ++i) cloud.xyz.push_back({part(random), part(random), part(random)});
  cloud.sigma_m.assign(cloud.size(), 0.2f);
  const PatchCloud patches = reduce_to_patches(cloud, 1);
  ASSERT_EQ(patches.size(), 1u);
  EXPECT_EQ(patches.origin, cloud.origin);
  const SurfacePatch& patch = patches.patches.front();

  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : cloud.xyz) mean += p.cast<double>() / double(cloud.size());
  for (const auto& p : cloud.xyz) covariance += (p.cast<double>() - mean) * (p.cast<double>() - mean).transpose() / double(cloud.size());
  EXPECT_LT((patch.mean.cast<double>() - mean).norm(), 1e-5);
  EXPECT_NEAR(patch.covariance[0], covariance(0, 0), 1e-5);
  EXPECT_NEAR(patch.covariance[2], covariance(0, 2), 1e-5);
  EXPECT_NEAR(patch.covariance[4], covariance(1, 2), 1e-5);
  EXPECT_EQ(patch.count, 500);
  EXPECT_NEAR(patch.sigma_m, 0.2, 1e-6);
  EXPECT_TRUE(patch.normal.isZero(0));
}

TEST(SurfacePatches, KeepTheFacesOfACornerApart) {
  PointCloud corner;
  for (float u = 0.05f; u < 1; u += 0.1f)
    for (float v = 0.05f; v < 1; v += 0.1f) {
      corner.xyz.insert(corner.xyz.end(), {{u, v, 0.02f}, {u, 0.97f, v}, {u, v, 0.6f}});
      corner.normal.insert(corner.normal.end(), {Eigen::Vector3f::UnitZ(), -Eigen::Vector3f::UnitY(), Eigen::Vector3f::UnitZ()});
    }
  const PatchCloud patches = reduce_to_patches(corner, 1);
  ASSERT_EQ(patches.size(), 3u);   // ground, wall, and what lies above the ground
  EXPECT_LT((patches.patches[0].mean - Eigen::Vector3f(0.5f, 0.5f, 0.02f)).norm(), 1e-4);
  EXPECT_EQ(patches.patches[1].normal, -Eigen::Vector3f::UnitY());
  EXPECT_LT((patches.patches[2].mean - Eigen::Vector3f(0.5f, 0.5f, 0.6f)).norm(), 1e-4);
}

TEST(SurfacePatches, CountEveryFinitePointOnce) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> part(-20, 20);
  PointCloud cloud;
  for (int i = 0; i < 5000; ++i) cloud.xyz.push_back({part(random), part(random), 0.1f * part(random)});
  cloud.xyz.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  cloud.normal.assign(cloud.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < cloud.size(); i += 2) cloud.normal[i] = Eigen::Vector3f::UnitZ();
  cloud.sigma_m.assign(cloud.size(), std::numeric_limits<float>::quiet_NaN());
  float count = 0;
  for (const SurfacePatch& patch : reduce_to_patches(cloud, 1).patches) {
    count += patch.count;
    EXPECT_EQ(patch.sigma_m, 0);
  }
  EXPECT_EQ(count, 5000);
}

}  // namespace
}  // namespace priormap
