#include <priormap/geodesy/interpolated_transformer.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

using Eigen::Vector3d;
using priormap::Bounds2;
using priormap::Crs;
using priormap::InterpolatedTransformer;
using priormap::Transformer;

namespace {

struct Region {
  const char *source, *target;
  Bounds2 bounds;
};

class InterpolationTest : public ::testing::TestWithParam<Region> {};

TEST_P(InterpolationTest, StaysWithinTheToleranceEverywhere) {
  const Region& region = GetParam();
  const Transformer exact(Crs::parse(region.source), Crs::parse(region.target));
  for (const double tolerance_m : {0.001, 0.00001}) {
    const InterpolatedTransformer fast(exact, region.bounds, tolerance_m);
    ASSERT_TRUE(fast.interpolates());
    EXPECT_LE(fast.error_bound_m(), tolerance_m);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> x(region.bounds.min_x, region.bounds.max_x), y(region.bounds.min_y, region.bounds.max_y);
    std::vector<Vector3d> points;
    for (int n = 0; n < 20000; ++n) points.emplace_back(x(random), y(random), 100 + n);
    for (const double cx : {region.bounds.min_x, region.bounds.max_x})
      for (const double cy : {region.bounds.min_y, region.bounds.max_y}) points.emplace_back(cx, cy, 5);
    std::vector<Vector3d> expected = points;
    exact.forward(expected);
    fast.forward(points);
    const double unit_m = exact.target().is_geographic() ? 111320 : exact.target().horizontal_unit_m();
    double worst_m = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      worst_m = std::max(worst_m, (points[i] - expected[i]).head<2>().norm() * unit_m);
      ASSERT_EQ(points[i].z(), expected[i].z());
    }
    EXPECT_LE(worst_m, std::max(fast.error_bound_m(), 1e-7));
  }
}

INSTANTIATE_TEST_SUITE_P(Regions, InterpolationTest,
                         ::testing::Values(Region{"EPSG:27700", "EPSG:32630", {525000, 175000, 535000, 185000}},
                                           Region{"EPSG:25833", "EPSG:25832", {300000, 5700000, 500000, 5900000}},
                                           Region{"EPSG:4326", "EPSG:32632", {7, 43, 8, 44}},
                                           Region{"EPSG:2154", "EPSG:32631", {100000, 6100000, 1200000, 7100000}},
                                           Region{"EPSG:2263+6360", "EPSG:26918+5703", {980000, 200000, 1010000, 240000}},
                                           Region{"EPSG:28992", "EPSG:4326", {80000, 450000, 90000, 460000}}));

TEST(InterpolatedTransformerTest, TakesTheExactWayWhereItHasNoBound) {
  const Transformer heights(Crs::parse("EPSG:4979"), Crs::parse("EPSG:25832+5773"));
  EXPECT_FALSE(InterpolatedTransformer(heights, {11, 48, 12, 49}).interpolates());
  const Transformer utm(Crs::parse("EPSG:4326"), Crs::parse("EPSG:32632"));
  EXPECT_FALSE(InterpolatedTransformer(utm, {7, 85, 8, 95}).interpolates());
  const InterpolatedTransformer fast(utm, {7, 43, 8, 44});
  std::vector<Vector3d> points = {{9.5, 45, 1}, {std::nan(""), 43, 1}};
  fast.forward(points);
  EXPECT_EQ(points[0], utm.forward(Vector3d(9.5, 45, 1)));
  EXPECT_TRUE(points[1].array().isNaN().all());
}

TEST(InterpolatedTransformerTest, IdentityStaysExact) {
  const Transformer same(Crs::parse("EPSG:25832"), Crs::parse("EPSG:25832"));
  std::vector<Vector3d> points = {{500000.123456789, 5400000.987654321, 7}};
  const std::vector<Vector3d> expected = points;
  InterpolatedTransformer(same, {499000, 5399000, 501000, 5401000}).forward(points);
  EXPECT_EQ(points, expected);
}

}  // namespace
