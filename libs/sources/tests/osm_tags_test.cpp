#include <gtest/gtest.h>

#include <priormap/sources/osm_tags.hpp>

namespace priormap {
namespace {

TEST(OsmTags, LengthsAsMappersWriteThem) {
  const std::vector<std::pair<const char*, double>> table{
      {"22", 22},          {"22 m", 22},         {"22m", 22},        {" 22.5  m ", 22.5}, {"7,5", 7.5},         {"7.5 metres", 7.5}, {"650 cm", 6.5},
      {"0.3 km", 300},     {"72 ft", 21.9456},   {"72ft", 21.9456},  {"72'", 21.9456},    {"72'6\"", 22.098},   {"72' 6\"", 22.098}, {"72'6", 22.098},
      {"72 ft 6 in", 22.098}, {"10 feet", 3.048}, {"120 in", 3.048}, {"0", 0},            {"5\u20326\u2033", 1.6764}, {".5", 0.5},   {"22 M", 22},
  };
  for (const auto& [text, metres] : table) {
    ASSERT_TRUE(parse_length_m(text)) << text;
    EXPECT_NEAR(*parse_length_m(text), metres, 1e-9) << text;
  }
}

TEST(OsmTags, WhatIsNoLengthIsRefused) {
  for (const char* text : {"", "m", "tall", "-3", "3 storeys", "12;15", "10-12", "~20", "1.2.3", "1,234.5", "72'x\"", "nan", "inf", "1e3", "22 m m"})
    EXPECT_FALSE(parse_length_m(text)) << text;
}

TEST(OsmTags, Storeys) {
  EXPECT_EQ(parse_storeys("3"), 3);
  EXPECT_EQ(parse_storeys("2,5"), 2.5);
  for (const char* text : {"", "three", "3 m", "2;3", "-1", "5000"}) EXPECT_FALSE(parse_storeys(text)) << text;
}

TEST(OsmTags, Directions) {
  EXPECT_EQ(parse_direction_deg("NW"), 315);
  EXPECT_EQ(parse_direction_deg("219.6"), 219.6);
  EXPECT_EQ(parse_direction_deg("90\u00b0"), 90);
  EXPECT_EQ(parse_direction_deg("-90"), 270);
  for (const char* words : {"north-west", "Northwest", "north west"}) EXPECT_EQ(parse_direction_deg(words), 315) << words;
  EXPECT_EQ(parse_direction_deg("south-southeast"), 157.5);
  EXPECT_EQ(parse_direction_deg("east"), 90);
  EXPECT_EQ(compass_half_step_deg("NW"), 22.5);
  EXPECT_EQ(compass_half_step_deg("north-northwest"), 11.25);
  EXPECT_EQ(compass_half_step_deg("315"), 0);
  EXPECT_FALSE(parse_direction_deg("up"));
  EXPECT_FALSE(parse_direction_deg("400"));
}

struct Tagged {
  explicit Tagged(std::initializer_list<std::pair<const char*, const char*>> pairs) {
    for (const auto& [key, value] : pairs) tags.add(key, value);
    attributes = tags.attributes("way/1", diagnostics);
  }
  OsmBuildingTags tags;
  Diagnostics diagnostics;
  BuildingAttributes attributes;
};

TEST(OsmTags, WhatStandsAboveTheGroundIsABuilding) {
  EXPECT_TRUE(Tagged({{"building", "yes"}}).tags.is_building());
  EXPECT_TRUE(Tagged({{"building:part", "yes"}}).tags.is_part());
  EXPECT_FALSE(Tagged({{"building", "no"}}).tags.is_building());
  EXPECT_FALSE(Tagged({{"building", "yes"}, {"location", "underground"}}).tags.is_building());
  EXPECT_FALSE(Tagged({{"demolished:building", "yes"}}).tags.is_building());
  EXPECT_FALSE(Tagged({{"building", "demolished"}}).tags.is_building());
  EXPECT_FALSE(Tagged({{"building", "bridge"}, {"man_made", "bridge"}}).tags.is_building());
  EXPECT_FALSE(Tagged({{"building", "yes"}, {"building:levels", "0"}, {"building:levels:underground", "2"}}).tags.is_building());
  EXPECT_FALSE(Tagged({{"highway", "service"}}).tags.is_building());
}

TEST(OsmTags, CanopiesHaveNoWalls) {
  EXPECT_FALSE(Tagged({{"building", "roof"}}).attributes.has_walls);
  EXPECT_FALSE(Tagged({{"building", "carport"}}).attributes.has_walls);
  EXPECT_TRUE(Tagged({{"building", "house"}}).attributes.has_walls);
}

TEST(OsmTags, AttributesInMetresAndStoreys) {
  const Tagged object({{"building", "yes"}, {"height", "72'6\""}, {"min_height", "3"}, {"building:levels", "5"}, {"roof:levels", "1"},
                       {"roof:shape", "half-hipped"}, {"roof:height", "3,5 m"}, {"roof:direction", "SE"}, {"roof:orientation", "across"}});
  EXPECT_NEAR(*object.attributes.height_m, 22.098, 1e-9);
  EXPECT_EQ(object.attributes.min_height_m, 3);
  EXPECT_EQ(object.attributes.levels, 5);
  EXPECT_EQ(object.attributes.roof_levels, 1);
  EXPECT_EQ(object.attributes.roof_shape, RoofShape::half_hipped);
  EXPECT_EQ(object.attributes.roof_height_m, 3.5);
  EXPECT_EQ(object.attributes.roof_direction_deg, 135);
  EXPECT_TRUE(object.attributes.ridge_across);
  EXPECT_EQ(object.diagnostics.total(), 0u);
}

TEST(OsmTags, UnusableValuesAreCountedAndAbsent) {
  const Tagged object({{"building", "yes"}, {"height", "tall"}, {"building:levels", "many"}, {"min_height", "-2"}});
  EXPECT_FALSE(object.attributes.height_m);
  EXPECT_FALSE(object.attributes.levels);
  EXPECT_FALSE(object.attributes.min_height_m);
  EXPECT_EQ(object.diagnostics.counts().at(DiagnosticCode::unusable_height), 3u);
  EXPECT_EQ(Tagged({{"building", "yes"}, {"height", "5"}, {"min_height", "6"}}).diagnostics.total(), 1u);
}

}  // namespace
}  // namespace priormap
