#include <priormap/builder/prior_crs.hpp>

#include <gtest/gtest.h>

#include <functional>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

LonLatArea area_at(const GeoPoint& place) { return {place.lon_deg, place.lat_deg, place.lon_deg, place.lat_deg}; }

const GeoPoint munich{48.1, 11.5, 0};

struct Resolved {
  std::optional<Crs> crs;
  std::vector<std::string> warnings;
  std::string error;
};

Resolved resolve_in(const LonLatArea& area, const PriorOptions& options, const std::vector<std::string>& declared) {
  Resolved resolved;
  Events events;
  events.warning = [&](const std::string& message) { resolved.warnings.push_back(message); };
  try {
    std::vector<InputCrs> inputs;
    for (const std::string& text : declared)
      inputs.push_back(resolve_input_crs(options, text.empty() ? std::nullopt : std::optional(Crs::parse(text)), "input.tif", events));
    resolved.crs = resolve_prior_crs(options, inputs, area, events);
  } catch (const Error& error) {
    resolved.error = error.what();
  }
  return resolved;
}

Resolved resolve(const PriorOptions& options, const std::vector<std::string>& declared, const GeoPoint& place = munich) { return resolve_in(area_at(place), options, declared); }

PriorOptions with(const std::function<void(PriorOptions&)>& set) {
  PriorOptions options;
  set(options);
  return options;
}

TEST(PriorCrs, the_default_is_the_utm_zone_of_the_data) {
  EXPECT_EQ(resolve({}, {"EPSG:4326+5773"}).crs->name(), "EPSG:32632+5773");
  EXPECT_EQ(resolve({}, {"EPSG:4258+5773"}).crs->name(), "EPSG:25832+5773");
  EXPECT_EQ(resolve({}, {"EPSG:3006"}, {57.69, 11.96, 0}).crs->name(), "EPSG:25832") << "SWEREF99 is ETRS89";
}

TEST(PriorCrs, data_in_a_utm_zone_stay_in_it) {
  EXPECT_EQ(resolve({}, {"EPSG:26918"}, {40.8, -73.9, 0}).crs->name(), "EPSG:26918");
  EXPECT_EQ(resolve({}, {"EPSG:25832+7837", "EPSG:25832+7837"}).crs->name(), "EPSG:25832+7837");
  EXPECT_EQ(resolve({}, {"EPSG:25832", "EPSG:25833"}).crs->name(), "EPSG:25832") << "two zones: the zone of the middle";
}

TEST(PriorCrs, undeclared_heights_stay_undeclared_with_one_warning) {
  const Resolved resolved = resolve({}, {"EPSG:25832", "EPSG:25832"});
  EXPECT_FALSE(resolved.crs->has_vertical());
  EXPECT_FALSE(vertical_name(*resolved.crs));
  ASSERT_EQ(resolved.warnings.size(), 1u);
  EXPECT_NE(resolved.warnings[0].find("--assume-vertical"), std::string::npos);
}

TEST(PriorCrs, a_named_vertical_crs_from_undeclared_heights_is_refused_with_the_remedy) {
  const Resolved resolved = resolve(with([](auto& o) { o.crs = "EPSG:25832+7837"; }), {"EPSG:25832"});
  EXPECT_FALSE(resolved.crs);
  EXPECT_NE(resolved.error.find("input.tif: heights are undeclared"), std::string::npos);
  EXPECT_NE(resolved.error.find("say --assume-vertical EPSG:7837 if they are in it"), std::string::npos) << resolved.error;
}

TEST(PriorCrs, an_option_that_brings_heights_is_advised_before_an_assumption) {
  const InputCrs outlines{Crs::parse("EPSG:4326"), "", "town.osm", "--terrain"};
  Events events;
  std::string warning;
  events.warning = [&](const std::string& text) { warning = text; };
  resolve_prior_crs({}, {outlines}, LonLatArea{11, 48, 11, 48}, events);
  EXPECT_NE(warning.find("give --terrain with declared heights, or --assume-vertical V"), std::string::npos) << warning;
  try {
    resolve_prior_crs(with([](auto& o) { o.crs = "EPSG:25832+7837"; }), {outlines}, LonLatArea{11, 48, 11, 48}, {});
    FAIL();
  } catch (const CrsError& error) {
    EXPECT_NE(std::string(error.what()).find("; give --terrain with declared heights, or say --assume-vertical EPSG:7837 if they are in it"), std::string::npos) << error.what();
  }
}

TEST(PriorCrs, the_users_word_declares_heights) {
  EXPECT_EQ(resolve(with([](auto& o) { o.crs = "EPSG:25832+7837"; o.assume_vertical = "EPSG:7837"; }), {"EPSG:25832"}).crs->name(), "EPSG:25832+7837");
  EXPECT_EQ(resolve(with([](auto& o) { o.assume_vertical = "EPSG:7837"; }), {"EPSG:25832"}).crs->name(), "EPSG:25832+7837");
  EXPECT_EQ(resolve(with([](auto& o) { o.source_crs = "EPSG:25832+7837"; }), {""}).crs->name(), "EPSG:25832+7837");
}

TEST(PriorCrs, assumed_heights_are_recorded_and_declared_ones_keep_their_own) {
  const PriorOptions options = with([](auto& o) { o.assume_vertical = "EPSG:5773"; });
  EXPECT_EQ(resolve_input_crs(options, Crs::parse("EPSG:25832"), "a", {}).assumed_vertical, "EPSG:5773");
  const InputCrs declared = resolve_input_crs(options, Crs::parse("EPSG:25832+7837"), "a", {});
  EXPECT_EQ(declared.assumed_vertical, "");
  EXPECT_EQ(declared.crs.name(), "EPSG:25832+7837");
}

TEST(PriorCrs, unusable_systems_are_refused) {
  const auto error = [&](const std::string& crs, const std::string& declared) { return resolve(with([&](auto& o) { o.crs = crs; }), {declared}).error; };
  EXPECT_NE(error("EPSG:4326", "EPSG:4326").find("not projected"), std::string::npos);
  EXPECT_NE(error("EPSG:4326", "EPSG:4326").find("here the UTM zone EPSG:326"), std::string::npos) << error("EPSG:4326", "EPSG:4326");
  EXPECT_NE(error("EPSG:4258", "EPSG:4326").find("here the UTM zone EPSG:258"), std::string::npos) << "of the same datum";
  EXPECT_NE(error("EPSG:2263", "EPSG:4326").find("not in metres"), std::string::npos) << "US survey feet";
  EXPECT_NE(error("nonsense", "EPSG:4326").find("--crs"), std::string::npos);
  EXPECT_NE(error("", "").find("no coordinate reference system"), std::string::npos);
  EXPECT_NE(error("", "EPSG:4979").find("ellipsoidal"), std::string::npos);
  EXPECT_NE(resolve({}, {"EPSG:25832+7837", "EPSG:25832+5773"}).error.find("--crs H+V"), std::string::npos);
  EXPECT_NE(resolve({}, {"EPSG:25832+7837", "EPSG:25832"}).error.find("undeclared"), std::string::npos);
  EXPECT_NE(resolve({}, {"EPSG:25832+7837", "EPSG:25832"}).error.find("say --assume-vertical EPSG:7837 if"), std::string::npos);
  EXPECT_NE(resolve(with([](auto& o) { o.assume_vertical = "EPSG:25832"; }), {"EPSG:25832"}).error.find("no vertical CRS"), std::string::npos);
  EXPECT_NE(resolve(with([](auto& o) { o.source_crs = "EPSG:5773"; }), {"EPSG:25832"}).error.find("heights only"), std::string::npos);
}

TEST(PriorCrs, a_zone_beside_the_data_is_warned_of_and_a_far_one_refused) {
  const auto asked = [](const std::string& crs) { return with([&](auto& o) { o.crs = crs; }); };
  EXPECT_TRUE(resolve(asked("EPSG:25832+7837"), {"EPSG:4258+7837"}).warnings.empty());
  EXPECT_TRUE(resolve(asked("EPSG:25832+7837"), {"EPSG:4258+7837"}, {48.1, 12.2, 0}).warnings.empty()) << "a city on the border of its zone";
  const Resolved beside = resolve(asked("EPSG:25833+7837"), {"EPSG:4258+7837"}, {49.0, 8.4, 0});
  EXPECT_EQ(beside.crs->name(), "EPSG:25833+7837") << "as asked";
  ASSERT_EQ(beside.warnings.size(), 1u);
  for (const char* part : {"--crs EPSG:25833+7837 (ETRS89 / UTM zone 33N) is meant for longitudes 12 to 18", "longitude 8.400, latitude 49.000", "EPSG:25832 fits there"})
    EXPECT_NE(beside.warnings[0].find(part), std::string::npos) << beside.warnings[0];
  EXPECT_TRUE(resolve(asked("EPSG:25833+7837"), {"EPSG:4258+7837"}, {70.4, 31.1, 0}).crs) << "all of Norway is mapped in zone 33";
  EXPECT_NE(resolve(asked("EPSG:32632+5773"), {"EPSG:4326+5773"}, {49.0, 28, 0}).error.find("makes lengths wrong by 2.3 %"), std::string::npos);
  EXPECT_NE(resolve(asked("EPSG:32632+5773"), {"EPSG:4326+5773"}, {40.8, -73.9, 0}).error.find("EPSG:32618 fits there"), std::string::npos);
  EXPECT_NE(resolve(asked("EPSG:3857"), {"EPSG:4326"}).error.find("EPSG:3857"), std::string::npos) << "Web Mercator has no metres";
}

TEST(PriorCrs, lengths_are_looked_at_where_the_data_reach_not_in_their_middle_alone) {
  const LonLatArea europe{-10, 36, 40, 60}, norway{4.5, 57.9, 31.1, 71.2};
  const Resolved by_default = resolve_in(europe, {}, {"EPSG:4326"});
  for (const char* part : {"EPSG:32633 (WGS 84 / UTM zone 33N) makes lengths wrong by 4.2 %", "longitude 40.000, latitude 48.000", "--bbox keeps a part of the data"})
    EXPECT_NE(by_default.error.find(part), std::string::npos) << by_default.error;
  EXPECT_NE(resolve_in(europe, with([](auto& o) { o.crs = "EPSG:32633"; }), {"EPSG:4326"}).error.find("--crs EPSG:32633"), std::string::npos);
  EXPECT_EQ(resolve_in(europe, with([](auto& o) { o.crs = "EPSG:32633"; o.bbox = {14, 48, 16, 50}; }), {"EPSG:4326"}).error, "") << "the box keeps what fits";
  const Resolved at_corner = resolve_in(norway, with([](auto& o) { o.crs = "EPSG:25833+5773"; }), {"EPSG:4258+5773"});
  EXPECT_EQ(at_corner.error, "") << "no data lie at that corner";
  ASSERT_EQ(at_corner.warnings.size(), 1u);
  EXPECT_NE(at_corner.warnings[0].find("makes lengths wrong by 1.1 % at a corner of the data's extent (longitude 31.100, latitude 57.900)"), std::string::npos) << at_corner.warnings[0];
}

TEST(PriorCrs, the_zone_of_data_across_the_antimeridian) {
  EXPECT_EQ(resolve_in({179.5, -18, -179.8, -17}, {}, {"EPSG:4326"}).crs->name(), "EPSG:32760");
  EXPECT_EQ(resolve_in({179.8, -18, -179.5, -17}, {}, {"EPSG:4326"}).crs->name(), "EPSG:32701");
}

TEST(PriorCrs, undeclared_heights_of_data_in_feet_are_taken_as_metres_and_that_is_said) {
  const auto warning = [](const std::string& crs) { return resolve(with([](auto& o) { o.crs = "EPSG:32618"; }), {crs}, GeoPoint{40.8, -73.9, 0}).warnings.at(0); };
  EXPECT_NE(warning("EPSG:2263").find("taken as metres though x and y are not"), std::string::npos);
  EXPECT_EQ(warning("EPSG:32618").find("taken as metres"), std::string::npos);
}

TEST(PriorCrs, a_box_beside_the_data_or_no_data_at_all_is_not_the_crs_s_fault) {
  EXPECT_EQ(resolve(with([](auto& o) { o.crs = "EPSG:25832"; o.bbox = {0, 0, 1, 1}; }), {"EPSG:4326"}).error, "");
  EXPECT_EQ(resolve_prior_crs(with([](auto& o) { o.crs = "EPSG:25832"; }), {}, std::nullopt, {}).name(), "EPSG:25832");
}

TEST(PriorCrs, what_a_box_keeps_counts_not_the_whole_file) {
  PriorOptions options = with([](auto& o) { o.crs = "EPSG:25833"; o.bbox = {13.3, 52.4, 13.5, 52.6}; });
  EXPECT_EQ(resolve(options, {"EPSG:25832"}, {51, 8, 0}).warnings.size(), 1u) << "undeclared heights alone";
}

TEST(PriorCrs, an_override_of_what_a_file_says_is_told) {
  const auto warnings = [](const std::string& source_crs, const std::string& declared) {
    Resolved resolved = resolve(with([&](auto& o) { o.source_crs = source_crs; o.crs = "EPSG:25832+7837"; }), {declared});
    EXPECT_EQ(resolved.error, "");
    return resolved.warnings;
  };
  ASSERT_EQ(warnings("EPSG:25833+7837", "EPSG:25832+7837").size(), 1u);
  EXPECT_EQ(warnings("EPSG:25833+7837", "EPSG:25832+7837")[0], "input.tif: says that it is in EPSG:25832+7837; read as EPSG:25833+7837 by --source-crs");
  EXPECT_EQ(warnings("EPSG:25832+7837", "EPSG:25832+5783").size(), 1u) << "other heights";
  EXPECT_TRUE(warnings("EPSG:25832+7837", "EPSG:25832").empty()) << "completed, not contradicted";
  EXPECT_TRUE(warnings("EPSG:25832+7837", "").empty());
}

}  // namespace
}  // namespace priormap
