#include <gtest/gtest.h>

#include <map>
#include <priormap/core/error.hpp>
#include <priormap/registration/scan_reducer.hpp>
#include <random>
#include <tuple>

using namespace priormap;

namespace {

PointCloud random_cloud(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> u(-20, 20);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = u(random), y = u(random), z = 0.1f * u(random);
    cloud.xyz.emplace_back(x, y, z);
  }
  return cloud;
}

struct Plain {
  double n = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
};

TEST(ScanReducer, MomentsEqualThoseOfThePointsOfEachVoxel) {
  const PointCloud cloud = random_cloud(50000, 1);
  std::map<std::tuple<int, int, int>, Plain> voxels;
  for (const auto& p : cloud.xyz) {
    const Eigen::Vector3i v = (p / 1.5f).array().floor().cast<int>();
    Plain& plain = voxels[{v.x(), v.y(), v.z()}];
    plain.n += 1;
    plain.sum += p.cast<double>();
    plain.squares += p.cast<double>() * p.cast<double>().transpose();
  }
  ScanReducer reducer(1.5);
  const SurfelCloud surfels = reducer.reduce(cloud);
  ASSERT_EQ(surfels.size(), voxels.size());
  for (const Surfel& s : surfels.surfels) {
    const Eigen::Vector3i v = (s.mean / 1.5f).array().floor().cast<int>();
    const Plain& plain = voxels.at({v.x(), v.y(), v.z()});
    const Eigen::Vector3d mean = plain.sum / plain.n;
    const Eigen::Matrix3d covariance = plain.squares / plain.n - mean * mean.transpose();
    EXPECT_EQ(double(s.count), plain.n);
    EXPECT_LT((s.mean.cast<double>() - mean).norm(), 1e-5);
    EXPECT_NEAR(s.covariance[0], covariance(0, 0), 1e-5);
    EXPECT_NEAR(s.covariance[1], covariance(0, 1), 1e-5);
    EXPECT_NEAR(s.covariance[2], covariance(0, 2), 1e-5);
    EXPECT_NEAR(s.covariance[3], covariance(1, 1), 1e-5);
    EXPECT_NEAR(s.covariance[4], covariance(1, 2), 1e-5);
    EXPECT_NEAR(s.covariance[5], covariance(2, 2), 1e-5);
  }
}

TEST(ScanReducer, AReducerUsedBeforeGivesTheSameBytesAsANewOne) {
  ScanReducer used(0.3), fresh(0.3);
  used.reduce(random_cloud(60000, 2));
  const auto a = used.reduce(random_cloud(20000, 3)), b = fresh.reduce(random_cloud(20000, 3));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.surfels[i].mean, b.surfels[i].mean);
    EXPECT_EQ(a.surfels[i].covariance, b.surfels[i].covariance);
  }
}

TEST(ScanReducer, CoarseningEqualsReducingCoarsely) {
  const PointCloud cloud = random_cloud(50000, 4);
  const SurfelCloud direct = ScanReducer(2.0).reduce(cloud), stepwise = coarsen(ScanReducer(0.5).reduce(cloud), 2.0);
  ASSERT_EQ(direct.size(), stepwise.size());
  for (std::size_t i = 0; i < direct.size(); ++i) {
    EXPECT_EQ(direct.surfels[i].count, stepwise.surfels[i].count);
    EXPECT_LT((direct.surfels[i].mean - stepwise.surfels[i].mean).norm(), 1e-4f);
    EXPECT_LT((direct.surfels[i].covariance - stepwise.surfels[i].covariance).norm(), 1e-4f);
  }
}

TEST(ScanReducer, LeavesOutWhatHasNoPlace) {
  PointCloud cloud;
  cloud.xyz = {{1, 2, 3}, {std::nanf(""), 0, 0}, {0, INFINITY, 0}, {0, 0, -3e7f}, {1.1f, 2.1f, 3.1f}};
  const SurfelCloud surfels = ScanReducer(1.0).reduce(cloud);
  ASSERT_EQ(surfels.size(), 1u);
  EXPECT_EQ(surfels.surfels[0].count, 2.0f);
  EXPECT_TRUE(ScanReducer(1.0).reduce({}).empty());
  EXPECT_THROW(ScanReducer(0), UsageError);
}

}  // namespace
