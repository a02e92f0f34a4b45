#include <priormap/geodesy/interpolated_transformer.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>

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

/// 20,000 places and the corners.
std::vector<Vector3d> places_in(const Bounds2& bounds) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> x(bounds.min_x, bounds.max_x), y(bounds.min_y, bounds.max_y);
  std::vector<Vector3d> points;
  for (int n = 0; n < 20000; ++n) points.emplace_back(x(random), y(random), 100 + n);
  for (const double cx : {bounds.min_x, bounds.max_x})
    for (const double cy : {bounds.min_y, bounds.max_y}) points.emplace_back(cx, cy, 5);
  return points;
}

double worst_distance_m(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b, const Crs& crs) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, (a[i] - b[i]).head<2>().norm());
  return worst * (crs.is_geographic() ? 111320 : crs.horizontal_unit_m());
}

TEST_P(InterpolationTest, StaysWithinTheToleranceEverywhereAndFarWithinInUse) {
  const Region& region = GetParam();
  const Transformer exact(Crs::parse(region.source), Crs::parse(region.target));
  InterpolatedTransformer fast(exact), back(exact, InterpolatedTransformer::Direction::inverse);
  std::vector<Vector3d> points = places_in(region.bounds), expected = points;
  ASSERT_TRUE(fast.interpolates_at(points[0].x(), points[0].y()));
  exact.forward(expected);
  fast.apply(points);
  EXPECT_LE(worst_distance_m(points, expected, exact.target()), 2e-6);
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(points[i].z(), expected[i].z());

  points = expected;
  ASSERT_TRUE(back.interpolates_at(points[0].x(), points[0].y()));
  exact.inverse(expected);
  back.apply(points);
  EXPECT_LE(worst_distance_m(points, expected, exact.source()), 2e-6);
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(points[i].z(), expected[i].z());
}

TEST_P(InterpolationTest, DependsOnThePlaceAlone) {
  const Region& region = GetParam();
  const Transformer exact(Crs::parse(region.source), Crs::parse(region.target));
  InterpolatedTransformer all(exact);
  std::vector<Vector3d> points = places_in(region.bounds), alone = points;
  all.apply(points);
  for (std::size_t i = 0; i < alone.size(); i += 1000) {
    InterpolatedTransformer one(exact);
    one.apply(std::span(&alone[i], 1));
    EXPECT_EQ(alone[i], points[i]);
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
  EXPECT_FALSE(InterpolatedTransformer(heights).interpolates_at(11, 48));
  const Transformer utm(Crs::parse("EPSG:4326"), Crs::parse("EPSG:32632"));
  InterpolatedTransformer fast(utm);
  EXPECT_TRUE(fast.interpolates_at(9.5, 45));
  EXPECT_FALSE(fast.interpolates_at(7.5, 89.99)) << "next to the pole";
  std::vector<Vector3d> points = {{9.5, 45, 1}, {7.5, 89.99, 1}, {std::nan(""), 43, 1}, {1e300, 43, 1}};
  fast.apply(points);
  EXPECT_LT((points[0] - utm.forward(Vector3d(9.5, 45, 1))).norm(), 1e-6);
  EXPECT_EQ(points[1], utm.forward(Vector3d(7.5, 89.99, 1)));
  EXPECT_TRUE(points[2].array().isNaN().all());
  EXPECT_TRUE(points[3].array().isNaN().all());
}

TEST(InterpolatedTransformerTest, IdentityStaysExact) {
  const Transformer same(Crs::parse("EPSG:25832"), Crs::parse("EPSG:25832"));
  std::vector<Vector3d> points = {{500000.123456789, 5400000.987654321, 7}};
  const std::vector<Vector3d> expected = points;
  InterpolatedTransformer(same).apply(points);
  EXPECT_EQ(points, expected);
}

}  // namespace
