#include <gtest/gtest.h>

#include <priormap/registration/register_scan.hpp>
#include <random>

using namespace priormap;

namespace {

/// Points 0.5 m apart on ground and three walls around a square of 40 m, open towards +x.
PointCloud courtyard(const Eigen::Vector3d& origin) {
  PointCloud cloud;
  cloud.origin = origin;
  for (float a = -20; a <= 20; a += 0.5f) {
    for (float b = -20; b <= 20; b += 0.5f) cloud.xyz.emplace_back(a, b, 0.f);
    for (float z = 0.5f; z <= 8; z += 0.5f) {
      cloud.xyz.emplace_back(a, 20.f, z);
      cloud.xyz.emplace_back(a, -20.f, z);
      cloud.xyz.emplace_back(-20.f, a, z);
    }
  }
  return cloud;
}

Eigen::Isometry3d pose(double x, double y, double z, double yaw) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

PointCloud seen_from(const PointCloud& world, const Eigen::Isometry3d& T_map_sensor) {
  PointCloud scan;
  const Eigen::Isometry3d T_sensor_map = T_map_sensor.inverse();
  for (std::size_t i = 0; i < world.size(); i += 3) scan.xyz.push_back((T_sensor_map * world.position(i)).cast<float>());
  return scan;
}

class RegisterScan : public testing::Test {
 protected:
  const Eigen::Vector3d origin{21000, -9000, 116};
  const PointCloud world = courtyard(origin);
  const Eigen::Isometry3d truth = pose(origin.x() + 2, origin.y() - 3, origin.z() + 1.8, 0.4);
  const PointCloud scan = seen_from(world, truth);
  VoxelHashMap map;
  void SetUp() override { map.insert(world); }
};

TEST_F(RegisterScan, FindsThePoseFromANearGuess) {
  const auto guess = truth * pose(0.15, -0.1, 0.1, 0.01);
  const auto result = register_scan(scan, map, guess, {});
  EXPECT_TRUE(result.converged);
  EXPECT_LT((result.T_target_source.translation() - truth.translation()).norm(), 2e-3);
  EXPECT_LT(local_coordinates(truth, result.T_target_source).head<3>().norm(), 1e-4);
  EXPECT_GT(result.inlier_share(), 0.99);
  EXPECT_EQ(result.num_correspondences, scan.size());
}

TEST_F(RegisterScan, SameBytesForAnyNumberOfThreads) {
  const auto guess = truth * pose(0.3, -0.2, 0.1, 0.02);
  const auto one = register_scan(scan, map, guess, {}, 1);
  for (const int threads : {2, 3, 8}) {
    const auto other = register_scan(scan, map, guess, {}, threads);
    EXPECT_EQ(one.T_target_source.matrix(), other.T_target_source.matrix());
    EXPECT_EQ(one.information, other.information);
    EXPECT_EQ(one.inlier_rmse_m, other.inlier_rmse_m);
  }
}

TEST_F(RegisterScan, TheInformationIsThatOfSensorAxes) {
  const auto result = register_scan(scan, map, truth, {});
  // Weights are 1 at zero residuals, so the translation block counts the points and the rotation block sums p^2 - p p^T.
  EXPECT_NEAR(result.information(3, 3), double(scan.size()), 0.01 * double(scan.size()));
  double about_x = 0;
  for (const auto& p : scan.xyz) about_x += double(p.y()) * p.y() + double(p.z()) * p.z();
  EXPECT_NEAR(result.information(0, 0), about_x, 0.01 * about_x);
  EXPECT_EQ(result.information, result.information.transpose());
}

TEST_F(RegisterScan, ClutterBeyondTheKernelCountsAsNoInlier) {
  PointCloud dirty = scan;
  for (std::size_t i = 0; i < dirty.size(); i += 2) dirty.xyz[i].z() += 1.5f;  // above the ground by more than the kernel's width
  const auto result = register_scan(dirty, map, truth, {});
  EXPECT_LT(result.inlier_share(), 0.9);
  EXPECT_LT((result.T_target_source.translation() - truth.translation()).norm(), 0.25);
}

TEST_F(RegisterScan, WithoutOverlapTheGuessComesBack) {
  const auto far = pose(0, 0, 0, 0);
  const auto result = register_scan(scan, map, far, {});
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.num_correspondences, 0u);
  EXPECT_EQ(result.inlier_share(), 0.0);
  EXPECT_EQ(result.T_target_source.matrix(), far.matrix());
}

}  // namespace
