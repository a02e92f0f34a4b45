#include "point_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace priormap {
namespace {

/// Everything compared with everything.
std::vector<PointRecord> in_plain_order(std::vector<PointRecord> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end(), same_point), points.end());
  return points;
}

bool are_equal(const std::vector<PointRecord>& a, const std::vector<PointRecord>& b) {
  return std::ranges::equal(a, b, [](const PointRecord& p, const PointRecord& q) { return sort_key(p) == sort_key(q); });
}

/// Walls as stacks of points upwards or downwards, some of them on each other, and single points between.
std::vector<PointRecord> made_tile(unsigned seed, std::int32_t extent, std::int32_t steps_of_height) {
  std::mt19937 random(seed);
  const auto up_to = [&](std::int32_t most) { return std::uniform_int_distribution<std::int32_t>(0, most)(random); };
  std::vector<PointRecord> points;
  for (int wall = 0; wall < 400; ++wall) {
    PointRecord p{};
    p.x = up_to(extent);
    p.y = up_to(extent);
    p.z = up_to(steps_of_height) * 500;
    p.source = static_cast<std::uint16_t>(up_to(1));
    p.feature = static_cast<std::uint32_t>(up_to(3));
    p.sigma_mm = static_cast<std::uint16_t>(up_to(1));
    const int count = up_to(2) == 0 ? 1 : 2 + up_to(20), step = up_to(1) == 0 ? 500 : -500;
    for (int i = 0; i < count; ++i, p.z += step) points.push_back(p);
  }
  return points;
}

TEST(PointOrder, IsThatOfComparingAllWithAll) {
  for (unsigned seed = 0; seed < 30; ++seed)
    for (const std::int32_t extent : {0, 3, 40, 200'000, 2'000'000'000}) {   // from one column for all to more bits than keys have
      std::vector<PointRecord> points = made_tile(seed, extent, 30), shuffled = points;
      const std::vector<PointRecord> expected = in_plain_order(points);
      sort_and_unite(points);
      EXPECT_TRUE(are_equal(points, expected)) << seed << " " << extent;
      std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(seed));
      sort_and_unite(shuffled);
      EXPECT_TRUE(are_equal(shuffled, expected)) << "in any order: " << seed << " " << extent;
    }
  std::vector<PointRecord> none;
  sort_and_unite(none);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace priormap
