#include "outline_groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace priormap {
namespace {

bool are_near(const LonLatArea& a, const LonLatArea& b) {
  const auto outside = [](double from_west, double width, double place) { return std::max({0.0, from_west - place, place - from_west - width}); };
  double lon = 360;
  for (const double turn : {-360.0, 0.0, 360.0}) {
    const double b_west = b.west_deg + turn;
    lon = std::min(lon, b_west > a.west_deg ? outside(a.west_deg, a.width_deg(), b_west) : outside(b_west, b.width_deg(), a.west_deg));
  }
  const double lat = std::max({0.0, a.south_deg - b.north_deg, b.south_deg - a.north_deg});
  return lon <= 1 && lat <= 1;
}

/// By comparing all with all until nothing changes.
std::vector<std::size_t> by_pairs(const std::vector<LonLatArea>& areas) {
  std::vector<std::size_t> lowest(areas.size());
  for (std::size_t i = 0; i < areas.size(); ++i) lowest[i] = i;
  for (bool changes = true; changes;) {
    changes = false;
    for (std::size_t i = 0; i < areas.size(); ++i)
      for (std::size_t k = 0; k < areas.size(); ++k)
        if (lowest[k] > lowest[i] && are_near(areas[i], areas[k])) lowest[k] = lowest[i], changes = true;
  }
  return lowest;
}

TEST(OutlineGroups, AreasHangTogetherAsTheyDoPairByPair) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int run = 0; run < 20; ++run) {
    std::vector<LonLatArea> areas;
    for (int i = 0; i < 400; ++i) {
      const double west = between(-180, 180), south = between(-20, 20), east = west + between(0, 2);
      areas.push_back({west, south, east > 180 ? east - 360 : east, south + between(0, 2)});
    }
    EXPECT_EQ(near_each_other(areas), by_pairs(areas));
  }
}

TEST(OutlineGroups, TheAntimeridianPartsNothing) {
  const std::vector<LonLatArea> areas{{179.5, 0, 179.9, 0.5}, {-179.8, 0, -179.5, 0.5}, {179.9, 5, -179.9, 5.5}};
  EXPECT_EQ(near_each_other(areas), (std::vector<std::size_t>{0, 0, 2}));
}

}  // namespace
}  // namespace priormap
