#include <gtest/gtest.h>

#include <map>
#include <priormap/core/error.hpp>
#include <priormap/registration/scan_reducer.hpp>
#include <numeric>
#include <random>
#include <tuple>

#include "street.hpp"

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

TEST(ScanReducer, MergedSurfelsHaveTheMomentsOfAllPoints) {
  PointCloud both = random_cloud(5000, 4);
  for (auto& p : both.xyz) p = p.cwiseAbs().cwiseMin(99.0f);   // into one voxel
  std::vector<std::uint32_t> first(2000), rest(3000);
  std::iota(first.begin(), first.end(), 0u);
  std::iota(rest.begin(), rest.end(), 2000u);
  ScanReducer reducer(100.0);
  const Surfel direct = reducer.reduce(both).surfels.at(0);
  Surfel merged = reducer.reduce(both.select(first)).surfels.at(0);
  merge(merged, reducer.reduce(both.select(rest)).surfels.at(0));
  EXPECT_EQ(direct.count, merged.count);
  EXPECT_LT((direct.mean - merged.mean).norm(), 1e-4f * direct.mean.norm());
  EXPECT_LT((direct.covariance - merged.covariance).norm(), 1e-4f * direct.covariance.norm());
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

SurfelCloud reduced(const street::World& world, const street::Laser& laser) {
  return ScanReducer(1.0).reduce(street::scan(world, street::pose(0, 0, 1.7, 0), laser, 1));
}

/// One wall, 30 m away, turned by `yaw` from facing the sensor.
street::World wall_ahead(double yaw) {
  const Eigen::Vector3d along(-std::sin(yaw), std::cos(yaw), 0);
  street::World world;
  world.faces.push_back({Eigen::Vector3d(30, 0, -10) + 15 * along, -30 * along, {0, 0, 20}});
  return world;
}

TEST(ScanReducer, TracesOnAWallTellItsNormalByThoseAroundThem) {
  for (const double yaw : {0.0, 0.4, -0.7}) {
    const SurfelCloud scan = reduced(wall_ahead(yaw), street::vlp16);
    ASSERT_EQ(scan.around.size(), scan.size());
    std::size_t told = 0;
    for (const SurfelShape& shape : scan.around) {
      if (shape.tells_nothing()) continue;
      ++told;
      EXPECT_EQ(shape.isotropic, 0);
      EXPECT_EQ(shape.directed, 1);
      EXPECT_GT(std::abs(shape.normal.dot(Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0).cast<float>())), std::cos(0.05));
      EXPECT_LT(shape.sigma_m, 0.05f);
    }
    EXPECT_GT(told, scan.size() * 9 / 10) << yaw;
  }
}

TEST(ScanReducer, RingsOnLevelGroundTellNothing) {
  street::World world;
  world.add_ground(-100, -100, 100, 100);
  const SurfelCloud scan = reduced(world, street::vlp16);
  ASSERT_EQ(scan.around.size(), scan.size());
  for (const SurfelShape& shape : scan.around) EXPECT_TRUE(shape.tells_nothing());
}

TEST(ScanReducer, TracesOnAPoleTellThatItStandsThere) {
  for (const double range_m : {10.0, 20.0}) {
    street::World world;
    world.add_box(range_m, 0, 0.2, 0.2, 6, 0.3);
    const SurfelCloud scan = reduced(world, street::vlp16);
    ASSERT_FALSE(scan.empty());
    ASSERT_EQ(scan.around.size(), scan.size());
    for (const SurfelShape& shape : scan.around) {
      EXPECT_EQ(shape.isotropic, 1);
      EXPECT_EQ(shape.directed, -1);
      EXPECT_GT(std::abs(shape.normal.z()), 0.99f);
      EXPECT_LT(shape.sigma_m, 0.1f);
    }
  }
}

TEST(ScanReducer, SurfelsOfManyLasersTellThemselves) {
  EXPECT_TRUE(reduced(street::canyon_with_piers(), {.columns = 2000}).around.empty());
}

TEST(SurfelCloud, OfWhatIsThinnedAllIsToldThatWas) {
  SurfelCloud scan = reduced(street::wide_street(), street::vlp16);
  scan.origin = {1, 2, 3};
  scan.normals.assign(scan.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < scan.size(); ++i) scan.normals[i].x() = float(i);
  ASSERT_EQ(scan.around.size(), scan.size());
  const SurfelCloud some = every(scan, 3);
  EXPECT_EQ(some.origin, scan.origin);
  ASSERT_EQ(some.size(), (scan.size() + 2) / 3);
  ASSERT_EQ(some.around.size(), some.size());
  ASSERT_EQ(some.normals.size(), some.size());
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some.surfels[i].mean, scan.surfels[3 * i].mean);
    EXPECT_EQ(some.around[i].normal, scan.around[3 * i].normal);
    EXPECT_EQ(some.normals[i], scan.normals[3 * i]);
  }
}

/// By its own points where they spread, by those around it where it is a trace; those of the others are not told.
TEST(Normals, AreThoseOfAllSurfelsThatTell) {
  SurfelCloud scan = reduced(street::wide_street(), street::vlp16);
  const SurfelCloud before = scan;
  ASSERT_EQ(before.around.size(), scan.size());
  tell_normals(scan, 1.0);
  ASSERT_EQ(scan.normals.size(), scan.size());
  EXPECT_TRUE(scan.around.empty());
  std::size_t num_of_own = 0, num_of_around = 0, num_unknown = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3f own = normal_of(scan.surfels[i], 1.0);
    const SurfelShape& around = before.around[i];
    const Eigen::Vector3f expected = !own.isZero(0) ? own : around.directed > 0 ? around.normal : Eigen::Vector3f::Zero();
    EXPECT_EQ(scan.normals[i], expected);
    ++(!own.isZero(0) ? num_of_own : expected.isZero(0) ? num_unknown : num_of_around);
  }
  EXPECT_GT(num_of_own, 50u);
  EXPECT_GT(num_of_around, 50u);
  EXPECT_GT(num_unknown, 10u);
}

}  // namespace
