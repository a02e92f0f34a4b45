#include "outline_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include <priormap/builder/building_solid.hpp>

namespace priormap {
namespace {

double total_m2(const std::vector<Bounds2>& boxes) {
  double sum = 0;
  for (const Bounds2& box : boxes) sum += (box.max_x - box.min_x) * (box.max_y - box.min_y);
  return sum;
}

std::size_t num_holding(const std::vector<Bounds2>& boxes, const Eigen::Vector2d& place) {
  return static_cast<std::size_t>(std::ranges::count_if(boxes, [&](const Bounds2& box) { return box.contains(place.x(), place.y()); }));
}

void expect_each_place_inside_held_once(const Polygon2& polygon, const std::vector<Bounds2>& boxes) {
  const Bounds2 bounds = bounds_of(polygon.exterior);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(bounds.min_x, bounds.max_x), y(bounds.min_y, bounds.max_y);
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector2d place(x(random), y(random));
    const std::size_t holding = num_holding(boxes, place);
    EXPECT_LE(holding, 1u);
    EXPECT_TRUE(holding == 1 || !contains(polygon, place)) << place.transpose();
  }
}

TEST(OutlineBoxes, OfASliverAcrossACityTheyHoldLittleMoreThanTheSliver) {
  const Polygon2 sliver{{{0, 0}, {1, 0}, {4001, 4000}, {4000, 4000}}, {}};
  const std::vector<Bounds2> boxes = boxes_over({sliver}, bounds_of(sliver.exterior), 32);
  EXPECT_LT(total_m2(boxes), 4000 * 4 * 32);
  expect_each_place_inside_held_once(sliver, boxes);
  for (int i = 1; i < 4000; ++i) EXPECT_EQ(num_holding(boxes, {i + 0.5, i}), 1u);
}

TEST(OutlineBoxes, OfAHallWithACourtyardTheyLeaveOutTheYard) {
  const Polygon2 hall{{{0, 0}, {600, 0}, {600, 500}, {0, 500}}, {{{100, 100}, {100, 400}, {500, 400}, {500, 100}}}};
  const std::vector<Bounds2> boxes = boxes_over({hall}, bounds_of(hall.exterior), 32);
  expect_each_place_inside_held_once(hall, boxes);
  EXPECT_LT(total_m2(boxes), area(hall) + 2 * (400 + 300) * 32.0);
  EXPECT_EQ(num_holding(boxes, {300, 250}), 0u);
}

TEST(OutlineBoxes, OfAHouseThereIsOne) {
  const Polygon2 house{{{0, 0}, {12, 3}, {10, 11}, {-2, 8}}, {}};
  const Bounds2 bounds = bounds_of(house.exterior);
  const std::vector<Bounds2> boxes = boxes_over({house}, bounds, 32);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_DOUBLE_EQ(total_m2(boxes), (bounds.max_x - bounds.min_x) * (bounds.max_y - bounds.min_y));
}

}  // namespace
}  // namespace priormap
