#include <priormap/pointcloud/estimate_normals.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace priormap {
namespace {

/// A slope that rises 3 in 10 towards east and falls 1 in 10 towards north.
PointCloud slope(double spacing_m, double noise_m) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, noise_m);
  PointCloud cloud;
  cloud.origin = {691'000, 5'336'000, 500};
  for (double x = 0; x < 40; x += spacing_m)
    for (double y = 0; y < 40; y += spacing_m) cloud.xyz.push_back({float(x), float(y), float(0.3 * x - 0.1 * y + noise(random))});
  return cloud;
}

TEST(EstimateNormals, OfASlopeAreThoseOfItsPlaneAtAnySpacing) {
  const Eigen::Vector3f truth = Eigen::Vector3f(-0.3f, 0.1f, 1).normalized();
  for (const double spacing_m : {0.2, 0.5, 1.0, 1.9}) {
    PointCloud cloud = slope(spacing_m, 0);
    estimate_normals(cloud);
    for (const Eigen::Vector3f& n : cloud.normal) ASSERT_LT((n - truth).norm(), 1e-2) << spacing_m;
  }
}

TEST(EstimateNormals, StateTheRoughnessAsSigma) {
  PointCloud cloud = slope(0.25, 0.05);
  cloud.sigma_m.assign(cloud.size(), 0.12f);
  estimate_normals(cloud);
  double sum = 0;
  for (const float sigma : cloud.sigma_m) sum += sigma;
  EXPECT_NEAR(sum / double(cloud.size()), std::hypot(0.12, 0.05), 0.01);
}

TEST(EstimateNormals, OfAWallLieFlatAndAgree) {
  std::mt19937 random(2);
  std::normal_distribution<float> noise(0, 0.02f);
  PointCloud cloud;
  for (float u = 0; u < 20; u += 0.3f)
    for (float z = 0; z < 8; z += 0.3f) cloud.xyz.push_back({0.8f * u + noise(random), 0.6f * u + noise(random), z});
  estimate_normals(cloud);
  for (const Eigen::Vector3f& n : cloud.normal) {
    ASSERT_GT(n.dot(cloud.normal.front()), 0.9f);
    ASSERT_NEAR(std::abs(n.dot(Eigen::Vector3f(-0.6f, 0.8f, 0))), 1, 0.02);
  }
}

TEST(EstimateNormals, KeepWhatIsKnownAndGuessNothing) {
  PointCloud cloud = slope(0.5, 0);
  cloud.normal.assign(cloud.size(), Eigen::Vector3f::UnitX());
  const PointCloud before = cloud;
  estimate_normals(cloud);
  EXPECT_EQ(cloud.normal, before.normal);
  EXPECT_TRUE(cloud.sigma_m.empty());

  PointCloud bush, line;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> part(0, 3);
  for (int i = 0; i < 1000; ++i) bush.xyz.push_back({part(random), part(random), part(random)});
  for (int i = 0; i < 100; ++i) line.xyz.push_back({0.1f * float(i), 0, 0});
  estimate_normals(bush);
  estimate_normals(line);
  EXPECT_LT(std::count_if(bush.normal.begin(), bush.normal.end(), [](const Eigen::Vector3f& n) { return !n.isZero(0); }), 20);
  for (const Eigen::Vector3f& n : line.normal) EXPECT_TRUE(n.isZero(0));
}

}  // namespace
}  // namespace priormap
