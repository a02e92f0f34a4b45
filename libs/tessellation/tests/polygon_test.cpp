#include <gtest/gtest.h>

#include <priormap/tessellation/polygon.hpp>

namespace priormap {
namespace {

const Polygon2 square_with_hole{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{2, 2}, {2, 4}, {4, 4}, {4, 2}}}};

TEST(Polygon, AreaLeavesHolesOutAndKnowsDirection) {
  EXPECT_DOUBLE_EQ(signed_area(square_with_hole.exterior), 100);
  EXPECT_DOUBLE_EQ(signed_area(square_with_hole.holes[0]), -4);
  EXPECT_DOUBLE_EQ(area(square_with_hole), 96);
}

TEST(Polygon, AreaKeepsItsDigitsAtUtmCoordinates) {
  const Eigen::Vector2d corner(691234.123, 5334567.987);
  EXPECT_NEAR(signed_area({corner, corner + Eigen::Vector2d(0.1, 0), corner + Eigen::Vector2d(0.1, 0.1)}), 0.005, 1e-9);
}

TEST(Polygon, ContainsByEvenOdd) {
  EXPECT_TRUE(contains(square_with_hole, {1, 1}));
  EXPECT_FALSE(contains(square_with_hole, {3, 3}));
  EXPECT_FALSE(contains(square_with_hole, {11, 5}));
  EXPECT_TRUE(contains(square_with_hole, {5, 4}));
}

TEST(Polygon, NewellNormalIsTwiceTheAreaOnTheCounterClockwiseSide) {
  const Polygon3 wall{{{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}}, {{{1, 0, 1}, {2, 0, 1}, {2, 0, 2}, {1, 0, 2}}}};
  EXPECT_TRUE(newell_normal(wall.exterior).isApprox(Eigen::Vector3d(0, -24, 0)));
  EXPECT_TRUE(newell_normal(wall).isApprox(Eigen::Vector3d(0, -22, 0))) << "the hole runs the wrong way and still counts off";
  EXPECT_DOUBLE_EQ(area(wall), 11);
}

}  // namespace
}  // namespace priormap
