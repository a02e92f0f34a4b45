#include <gtest/gtest.h>

#include <priormap/core/error.hpp>
#include <priormap/registration/voxel_hash_map.hpp>
#include <random>
#include <vector>

using namespace priormap;

namespace {

PointCloud random_cloud(std::size_t count, double half_edge, unsigned seed, const Eigen::Vector3d& origin) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> u(float(-half_edge), float(half_edge));
  PointCloud cloud;
  cloud.origin = origin;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = u(random), y = u(random), z = u(random);
    cloud.xyz.emplace_back(x, y, z);
  }
  return cloud;
}

TEST(VoxelHashMap, NearestEqualsASearchOfAllPointsInThe27Voxels) {
  const Eigen::Vector3d origin(31234.5, -17321.25, 512.125);
  VoxelHashMap map;
  map.insert(random_cloud(4000, 8, 1, origin));
  const PointCloud held = map.points(origin);
  const PointCloud queries = random_cloud(2000, 10, 2, origin);
  for (std::size_t q = 0; q < queries.size(); ++q) {
    const Eigen::Vector3d p = queries.position(q);
    double best = 1e300;
    for (std::size_t i = 0; i < held.size(); ++i) {
      const Eigen::Vector3d other = held.position(i);
      if (((other.array().floor() - p.array().floor()).abs() <= 1.0).all()) best = std::min(best, (other - p).norm());
    }
    const auto found = map.nearest(p);
    ASSERT_EQ(found.has_value(), best < 1e300);
    if (found) {
      EXPECT_NEAR(found->distance_m, best, 1e-5);
    }
  }
}

TEST(VoxelHashMap, AVoxelHoldsFewPointsAndNoneTooNearAnother) {
  VoxelHashMap map;
  map.insert(random_cloud(200000, 3, 3, Eigen::Vector3d::Zero()));
  EXPECT_EQ(map.voxel_count(), 216u);
  EXPECT_EQ(map.size(), 2160u);
  VoxelHashMap two;
  two.insert(Eigen::Vector3d(0.5, 0.5, 0.5));
  two.insert(Eigen::Vector3d(0.5, 0.55, 0.5));  // within 0.1 m
  two.insert(Eigen::Vector3d(0.5, 0.65, 0.5));
  EXPECT_EQ(two.size(), 2u);
  two.insert(Eigen::Vector3d(std::nan(""), 0, 0));
  EXPECT_EQ(two.size(), 2u);
}

TEST(VoxelHashMap, KeepsMillimetresFarFromTheOrigin) {
  VoxelHashMap map;
  const Eigen::Vector3d p(84123.4567, -5391234.1234, 519.8765);
  map.insert(p);
  const auto found = map.nearest(p + Eigen::Vector3d(0.3, 0, 0));
  ASSERT_TRUE(found);
  EXPECT_LT((found->position - p).norm(), 1e-6);
  EXPECT_NEAR(found->distance_m, 0.3, 1e-6);
}

TEST(VoxelHashMap, ForgetsWhatIsFarAndKeepsTheRest) {
  VoxelHashMap map;
  for (int x = 0; x < 300; ++x) map.insert(Eigen::Vector3d(x + 0.5, 0.5, 0.5));
  map.remove_beyond(Eigen::Vector3d(150.5, 0.5, 0.5), 100.0);
  EXPECT_EQ(map.size(), 201u);
  EXPECT_FALSE(map.nearest(Eigen::Vector3d(20.5, 0.5, 0.5)));
  EXPECT_TRUE(map.nearest(Eigen::Vector3d(60.5, 0.5, 0.5)));
  EXPECT_EQ(map.points().size(), 201u);
  map.insert(Eigen::Vector3d(20.5, 0.5, 0.5));
  EXPECT_TRUE(map.nearest(Eigen::Vector3d(20.5, 0.5, 0.5)));
}

TEST(VoxelHashMap, RefusesOptionsWithoutMeaning) {
  EXPECT_THROW(VoxelHashMap({.voxel_m = 0}), UsageError);
  EXPECT_THROW(VoxelHashMap({.max_points = 0}), UsageError);
}

TEST(VoxelHashMap, ACopyThroughItsStateGoesOnAlike) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-5, 5);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 20000; ++i) {
    const double x = u(random), y = u(random), z = u(random);
    points.emplace_back(0.01 * i + x, y, z);
  }
  const auto insert = [&](VoxelHashMap& map, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      map.insert(points[i]);
      if (i % 1000 == 0) map.remove_beyond(points[i], 20);
    }
  };
  VoxelHashMap whole, half, rest;
  insert(whole, 0, points.size());
  insert(half, 0, points.size() / 2);
  StateArchive out;
  half.exchange(out);
  StateArchive in(out.take());
  rest.exchange(in);
  in.expect_end();
  insert(rest, points.size() / 2, points.size());
  EXPECT_EQ(rest.size(), whole.size());
  EXPECT_EQ(rest.points().xyz, whole.points().xyz);
  for (const Eigen::Vector3d& p : points) {
    const auto a = whole.nearest(p), b = rest.nearest(p);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
      EXPECT_EQ(a->position, b->position);
    }
  }
}

}  // namespace
