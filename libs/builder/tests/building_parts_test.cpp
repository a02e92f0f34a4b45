#include <gtest/gtest.h>

#include <priormap/builder/building_parts.hpp>
#include <priormap/builder/building_solid.hpp>

namespace priormap {
namespace {

PartAssignment assign(const std::vector<ProjectedFootprint>& footprints) {
  ProjectedFootprints list(footprints.size());
  for (std::size_t i = 0; i < footprints.size(); ++i) list.put(i, footprints[i]);
  list.sort();
  return assign_parts(list);
}

ProjectedFootprint box(double west, double south, double east, double north, Footprint::Kind kind, std::uint32_t building = Footprint::no_building) {
  ProjectedFootprint footprint{{}, {{{{west, south}, {east, south}, {east, north}, {west, north}}, {}}}, {west, south, east, north}};
  footprint.footprint.kind = kind;
  footprint.footprint.building = building;
  return footprint;
}
constexpr auto outline = Footprint::Kind::outline, part = Footprint::Kind::part;

TEST(BuildingParts, FillTheirOutlineByArea) {
  const PartAssignment filled = assign(std::vector{box(0, 0, 20, 10, outline), box(0, 0, 12, 10, part), box(12, 0, 19.5, 10, part)});
  EXPECT_TRUE(filled.replaced[0]);
  EXPECT_EQ(filled.outline_of[1], 0u);
  EXPECT_EQ(filled.outline_of[2], 0u);
}

TEST(BuildingParts, ATowerOnABlockLeavesTheBlock) {
  EXPECT_FALSE(assign(std::vector{box(0, 0, 20, 10, outline), box(0, 0, 6, 6, part)}).replaced[0]);
}

TEST(BuildingParts, PartsThatLieOnEachOtherCountOnce) {
  EXPECT_FALSE(assign(std::vector{box(0, 0, 20, 10, outline), box(0, 0, 10, 10, part), box(0, 0, 10, 10, part)}).replaced[0]);
}

TEST(BuildingParts, APartBesideEveryOutlineStandsAlone) {
  const PartAssignment alone = assign(std::vector{box(0, 0, 20, 10, outline), box(20, 0, 30, 10, part)});
  EXPECT_EQ(alone.outline_of[1], PartAssignment::no_outline);
  EXPECT_FALSE(alone.replaced[0]);
}

TEST(BuildingParts, ARelationTiesPartsToItsOwnOutline) {
  const PartAssignment tied = assign(std::vector{box(0, 0, 20, 10, outline, 1), box(0, 0, 20, 10, outline, 2), box(0, 0, 20, 10, part, 2)});
  EXPECT_FALSE(tied.replaced[0]);
  EXPECT_TRUE(tied.replaced[1]);
  EXPECT_EQ(tied.outline_of[2], 1u);
}

/// A kilometre of canopy edge, a hand wide: a lattice over its bounds has a million places a square metre of it, and along an axis it slips between them.
TEST(BuildingParts, ASliverLiesWhereItsMiddleLineLies) {
  for (const Eigen::Vector2d& along : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 1).normalized(), Eigen::Vector2d(-3, 1).normalized()}) {
    constexpr double length = 1000, width = 1e-6;
    const Eigen::Vector2d start(50, 20), end = start + length * along, side = width * Eigen::Vector2d(-along.y(), along.x());
    ProjectedFootprint sliver{{}, {{{start, end, end + side, start + side}, {}}}, bounds_of({start, end, end + side, start + side})};
    sliver.footprint.kind = part;
    const auto crossing = [&](double share) {   // a box that holds this share of the sliver from its start
      const Eigen::Vector2d far = start + share * length * along;
      return box(std::min(start.x(), far.x()) - 1, std::min(start.y(), far.y()) - 1, std::max(start.x(), far.x()) + 1, std::max(start.y(), far.y()) + 1, outline);
    };
    EXPECT_EQ(assign(std::vector{crossing(0.55), sliver}).outline_of[1], 0u) << along.transpose();
    EXPECT_EQ(assign(std::vector{crossing(0.45), sliver}).outline_of[1], PartAssignment::no_outline) << along.transpose();
  }
}

TEST(BuildingParts, ARelationWithoutItsOutlineChangesNothing) {
  for (const std::uint32_t building_of_outline : {Footprint::no_building, 1u}) {
    const PartAssignment untied = assign(std::vector{box(0, 0, 20, 10, outline, building_of_outline), box(0, 0, 12, 10, part, 2), box(12, 0, 20, 10, part, 2)});
    EXPECT_TRUE(untied.replaced[0]);
    EXPECT_EQ(untied.outline_of[1], 0u);
  }
}

}  // namespace
}  // namespace priormap
