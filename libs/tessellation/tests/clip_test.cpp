#include <gtest/gtest.h>

#include <priormap/tessellation/clip.hpp>
#include <random>

#include "total_area.hpp"

namespace priormap {
namespace {

const Polygon2 comb{{{0, 0}, {9, 0}, {9, 6}, {7, 6}, {7, 2}, {5, 2}, {5, 6}, {4, 6}, {4, 2}, {2, 2}, {2, 6}, {0, 6}}, {}};
const Polygon2 frame{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{2, 2}, {2, 8}, {8, 8}, {8, 2}}}};

TEST(Clip, CutsAConcaveOutlineApart) {
  const auto teeth = clip(comb, {{0, -1}, 3});  // keeps y >= 3
  EXPECT_EQ(teeth.size(), 3u);
  EXPECT_NEAR(total_area(teeth), 3 * (2 + 1 + 2), 1e-9);
}

TEST(Clip, OpensAHole) {
  const auto half = clip(frame, {{1, 0}, -5});  // keeps x <= 5
  ASSERT_EQ(half.size(), 1u);
  EXPECT_TRUE(half[0].holes.empty());
  EXPECT_NEAR(total_area(half), 50 - 18, 1e-9);
  EXPECT_EQ(clip(frame, {{1, 0}, -9})[0].holes.size(), 1u) << "a hole beside the cut stays";
}

TEST(Clip, AlongAnEdgeOrBesideThePolygon) {
  EXPECT_NEAR(total_area(clip(comb, {{0, 1}, -2})), 18, 1e-9);
  EXPECT_NEAR(total_area(clip(comb, {{0, 1}, -6})), area(comb), 1e-9);
  EXPECT_TRUE(clip(comb, {{0, 1}, 0}).empty());
  EXPECT_TRUE(clip(comb, {{0, 1}, 1}).empty());
}

TEST(Clip, TheTwoSidesAddUp) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const Polygon2& polygon = i % 2 ? comb : frame;
    const LinearFunction side{{number(random), number(random)}, 4 * number(random)};
    EXPECT_NEAR(total_area(clip(polygon, side)) + total_area(clip(polygon, {-side.gradient, -side.offset})), area(polygon), 1e-9);
  }
}

}  // namespace
}  // namespace priormap
