#include <gtest/gtest.h>

#include <priormap/builder/building_height.hpp>

namespace priormap {
namespace {

const OutlineOptions options;   // 8 m, 4 m a storey

BuildingAttributes flat(std::optional<double> height_m, std::optional<double> levels) {
  BuildingAttributes attributes;
  attributes.height_m = height_m;
  attributes.levels = levels;
  return attributes;
}

TEST(BuildingHeight, TagThenSurfaceThenLevelsThenDefault) {
  const BuildingHeight by_tag = building_height(flat(12, 9), 20, 0, options);
  EXPECT_EQ(by_tag.rule, HeightRule::tag);
  EXPECT_EQ(by_tag.top_m, 12);
  const BuildingHeight by_surface = building_height(flat({}, 9), 20, 0, options);
  EXPECT_EQ(by_surface.rule, HeightRule::dsm);
  EXPECT_EQ(by_surface.top_m, 20);
  const BuildingHeight by_levels = building_height(flat({}, 3), {}, 0, options);
  EXPECT_EQ(by_levels.rule, HeightRule::levels);
  EXPECT_EQ(by_levels.top_m, 12);
  const BuildingHeight by_default = building_height(flat({}, {}), {}, 0, options);
  EXPECT_EQ(by_default.rule, HeightRule::fallback);
  EXPECT_EQ(by_default.top_m, 8);
  EXPECT_EQ(by_default.eaves_m, 8);
}

TEST(BuildingHeight, RoofLevelsAreStoreysOrTheRoof) {
  BuildingAttributes attributes = flat({}, 2);
  attributes.roof_levels = 1;
  EXPECT_EQ(building_height(attributes, {}, 0, options).top_m, 12);
  attributes.roof_shape = RoofShape::gabled;
  const BuildingHeight gabled = building_height(attributes, {}, 5, options);
  EXPECT_EQ(gabled.top_m, 12);
  EXPECT_EQ(gabled.eaves_m, 8);
}

TEST(BuildingHeight, TheRoofIsPartOfATaggedHeight) {
  BuildingAttributes attributes = flat(10, {});
  attributes.roof_shape = RoofShape::gabled;
  attributes.roof_height_m = 3;
  EXPECT_EQ(building_height(attributes, {}, 5, options).eaves_m, 7);
  attributes.roof_height_m.reset();
  attributes.roof_angle_deg = 45;
  EXPECT_NEAR(building_height(attributes, {}, 5, options).eaves_m, 5, 1e-9);
  attributes.roof_height_m = 40;
  EXPECT_EQ(building_height(attributes, {}, 5, options).eaves_m, 0) << "a roof can be the whole building, and no more";
}

TEST(BuildingHeight, WithoutAnyFigureTheRoofTakesAtMostHalfOfTheDefault) {
  BuildingAttributes attributes;
  attributes.roof_shape = RoofShape::dome;
  EXPECT_EQ(building_height(attributes, {}, 30, options).eaves_m, 4);
  EXPECT_EQ(building_height(attributes, {}, 30, options).top_m, 8);
}

TEST(BuildingHeight, WhatStandsOnPillarsStartsAboveTheGround) {
  BuildingAttributes attributes = flat(20, {});
  attributes.min_height_m = 6;
  EXPECT_EQ(building_height(attributes, {}, 0, options).bottom_m, 6);
  attributes = flat({}, 5);
  attributes.min_level = 2;
  const BuildingHeight height = building_height(attributes, {}, 0, options);
  EXPECT_EQ(height.bottom_m, 8);
  EXPECT_EQ(height.top_m, 20);
  attributes = {};
  attributes.min_height_m = 30;
  EXPECT_EQ(building_height(attributes, 12, 0, options).top_m, 38) << "a surface below its bottom does not show it";
}

TEST(BuildingHeight, LevelsBelowTheWallsAreAsHighAsTheBuildingsOwn) {
  BuildingAttributes tower = flat(60, 20);   // 3 m a storey
  tower.min_level = 18;
  EXPECT_DOUBLE_EQ(building_height(tower, {}, 0, options).bottom_m, 54);
  tower.roof_shape = RoofShape::pyramidal;   // its storeys end where the roof begins
  tower.roof_height_m = 10;
  EXPECT_DOUBLE_EQ(building_height(tower, {}, 8, options).bottom_m, 45);

  BuildingAttributes seen = flat({}, 20);
  seen.min_level = 18;
  const BuildingHeight by_surface = building_height(seen, 60, 0, options);
  EXPECT_EQ(by_surface.rule, HeightRule::dsm);
  EXPECT_DOUBLE_EQ(by_surface.bottom_m, 54);
}

TEST(BuildingHeight, WallsThatWouldStartAboveTheTopStartOnTheGround) {
  BuildingAttributes attributes = flat(12, {});
  attributes.min_level = 3;
  const BuildingHeight height = building_height(attributes, {}, 0, options);
  EXPECT_EQ(height.bottom_m, 0);
  EXPECT_EQ(height.eaves_m, 12);
}

}  // namespace
}  // namespace priormap
