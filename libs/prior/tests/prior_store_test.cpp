#include <priormap/prior/prior_store.hpp>

#include <thread>

#include <priormap/core/error.hpp>

#include "test_prior.hpp"

namespace priormap {
namespace {

void write_test_prior(const std::filesystem::path& directory, const std::string& crs = "") {
  PriorWriter writer(directory, test_manifest({test_source("a")}, 50, crs), Overwrite::refuse);
  PointCloud cloud = random_cloud(4000, 1, 300, {691'000, 5'336'000, 0});
  Feature house{.source = "a", .id = "way/1", .height_m = 12.5, .height_rule = "levels", .ground_z = 515.25, .sigma_m = 1};
  house.outline = {{{{691'010, 5'336'010}, {691'020.123, 5'336'010}, {691'020, 5'336'020.456}},
                    {{691'012, 5'336'011}, {691'013, 5'336'012}, {691'014, 5'336'011}}},
                   {{{691'030, 5'336'010}, {691'040, 5'336'010}, {691'040, 5'336'020}}}};
  cloud.feature.assign(cloud.size(), writer.add_feature(house));
  writer.add(cloud);
  writer.finish(2);
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void replace_in_file(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::string text = file_text(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  std::ofstream(file, std::ios::binary) << text.replace(at, from.size(), to);
}

TEST(PriorStore, TilesWithinAreThoseThatTouchTheBounds) {
  const TestFolder folder;
  write_test_prior(folder / "prior");
  const PriorStore store(folder / "prior");
  EXPECT_EQ(store.tiles_within({-1e12, -1e12, 1e12, 1e12}).size(), store.index().size());
  const TileGrid grid(50);
  const Bounds2 around{691'120, 5'336'130, 691'160, 5'336'155};
  std::vector<TileKey> expected;
  for (const TileEntry entry : store.tiles()) {
    const Bounds2 b = grid.bounds(entry.key);
    if (b.min_x <= around.max_x && b.max_x > around.min_x && b.min_y <= around.max_y && b.max_y > around.min_y)
      expected.push_back(entry.key);
  }
  EXPECT_EQ(store.tiles_within(around), expected);
  EXPECT_EQ(expected.size(), 4u);
}

TEST(PriorStore, FeaturesComeBackToTheMillimetre) {
  for (const std::string crs : {"", "EPSG:25832"}) {
    const TestFolder folder;
    write_test_prior(folder / "prior", crs);
    const std::vector<Feature> features = PriorStore(folder / "prior").features();
    ASSERT_EQ(features.size(), 1u);
    EXPECT_EQ(features[0].id, "way/1");
    EXPECT_EQ(features[0].height_m, 12.5);
    EXPECT_EQ(features[0].height_rule, "levels");
    EXPECT_EQ(features[0].ground_z, 515.25);
    ASSERT_EQ(features[0].outline.size(), 2u);
    ASSERT_EQ(features[0].outline[0].size(), 2u);
    EXPECT_EQ(features[0].outline[0][0][1], Eigen::Vector2d(691'020.123, 5'336'010));
    EXPECT_EQ(features[0].outline[0][0][2], Eigen::Vector2d(691'020, 5'336'020.456));
  }
}

TEST(PriorStore, OutlinesInTheFileAreLongitudesAndLatitudes) {
  const TestFolder folder;
  write_test_prior(folder / "prior", "EPSG:25832");
  const std::string line = file_text(folder / "prior/features.geojsonl");
  EXPECT_NE(line.find(R"("type":"MultiPolygon","coordinates":[[[[11.5)"), std::string::npos) << line;
  EXPECT_EQ(PriorStore(folder / "prior").manifest().features_crs, "EPSG:4326");
}

TEST(PriorStore, OutlinesGoToLongitudesAndLatitudesByTheOperationThatTheirSourceCameBy) {
  const Crs lon_lat = Crs::parse("EPSG:4326"), krovak = Crs::parse("EPSG:5514");
  const Eigen::Vector3d place(14.42, 50.08, 0);
  const Transformer czech(lon_lat, krovak, LonLatArea{14.4, 50, 14.5, 50.1});
  ASSERT_GT((Transformer(lon_lat, krovak).forward(place) - czech.forward(place)).norm(), 1) << "PROJ ranks another operation first without the area";
  PriorSource source = test_source("osm-1");
  source.operation = czech.operation();
  const TestFolder folder;
  PriorWriter writer(folder / "prior", test_manifest({source}, 200, "EPSG:5514"), Overwrite::refuse);
  const Eigen::Vector2d corner = czech.forward(place).head<2>().unaryExpr([](double v) { return std::round(v * 1000) / 1000; });
  Feature feature;
  feature.source = "osm-1";
  feature.id = "way/1";
  feature.outline = {{{corner, corner + Eigen::Vector2d(10, 0), corner + Eigen::Vector2d(0, 10)}}};
  PointCloud points = random_cloud(1, 1, 1, {corner.x(), corner.y(), 0});
  points.feature = {writer.add_feature(feature)};
  writer.add(points);
  writer.finish(1, {});

  const std::string line = file_text(folder / "prior/features.geojsonl"), ring = "\"coordinates\":[[[";
  const std::size_t start = line.find(ring) + ring.size();
  ASSERT_LT(start, line.size()) << line;
  EXPECT_NEAR(std::stod(line.substr(start)), place.x(), 2e-8);
  EXPECT_NEAR(std::stod(line.substr(line.find(',', start) + 1)), place.y(), 2e-8);
  EXPECT_EQ(PriorStore(folder / "prior").manifest().features_operation, czech.operation().proj_string);
  EXPECT_NEAR((PriorStore(folder / "prior").features()[0].outline[0][0][0] - corner).norm(), 0, 0.005) << "PROJ's Helmert transformations there and back differ by millimetres";
}

TEST(PriorStore, ManyThreadsReadAtOnce) {
  const TestFolder folder;
  write_test_prior(folder / "prior");
  const PriorStore store(folder / "prior");
  std::atomic<std::uint64_t> points = 0;
  {
    std::vector<std::jthread> readers;
    for (int t = 0; t < 4; ++t)
      readers.emplace_back([&] {
        for (const TileEntry entry : store.tiles()) points += store.load(entry.key).points.size();
      });
  }
  EXPECT_EQ(points, 4 * store.manifest().num_points);
}

TEST(PriorStore, NamesWhatIsWrong) {
  const TestFolder folder;
  const auto prior = folder / "prior";
  write_test_prior(prior);
  const TileKey key = PriorStore(prior).index().entry(0).key;
  const auto tile = PriorStore(prior).tile_file(key);
  EXPECT_NE(message_of([&] { PriorStore(folder / "none"); }).find("no prior.json"), std::string::npos);
  EXPECT_NE(message_of([&] { PriorStore(prior).load({0, 0}); }).find("no tile 0_0"), std::string::npos);

  const std::string whole = file_text(tile);
  std::ofstream(tile, std::ios::binary) << whole.substr(0, whole.size() - 10);
  EXPECT_NE(message_of([&] { PriorStore(prior).load(key); }).find("sha256"), std::string::npos);
  EXPECT_NE(message_of([&] { PriorStore(prior).load(key, false); }), "no error");
  std::filesystem::remove(tile);
  EXPECT_NE(message_of([&] { PriorStore(prior).load(key); }).find(tile.string()), std::string::npos);
}

TEST(PriorStore, ABrokenFeatureLineIsNamed) {
  const TestFolder folder;
  const auto prior = folder / "prior";
  write_test_prior(prior);
  const auto file = prior / "features.geojsonl";
  const std::string whole = file_text(file);
  for (const std::string& broken : {std::string("{"), std::string("[]"), whole.substr(0, whole.size() / 2), std::string("{\"id\":1}"),
                                   std::string(5000, '['), std::string("\n")}) {
    std::ofstream(file, std::ios::binary) << broken;
    EXPECT_NE(message_of([&] { PriorStore(prior).features(); }).find("features.geojsonl: line 1 is no feature"), std::string::npos) << broken;
  }
}

TEST(PriorStore, SchemaViolationsNameTheField) {
  const TestFolder folder;
  const auto prior = folder / "prior";
  write_test_prior(prior);
  const auto manifest = prior / "prior.json";
  const std::string whole = file_text(manifest);
  const auto message_after = [&](const std::string& from, const std::string& to) {
    std::ofstream(manifest, std::ios::binary) << whole;
    replace_in_file(manifest, from, to);
    return message_of([&] { PriorStore store(prior); });
  };
  EXPECT_NE(message_after("\"tile_size\": 50.0", "\"tile_size\": \"50\"").find("prior.json: tile_size: "), std::string::npos);
  EXPECT_NE(message_after("\"kind\": \"osm\"", "\"kind\": 3").find("sources[0].kind: "), std::string::npos);
  EXPECT_NE(message_after("\"generator\"", "\"generated\"").find("generat"), std::string::npos);
  EXPECT_NE(message_after("\"version\": 1", "\"version\": 2").find("version: "), std::string::npos);
  EXPECT_NE(message_after("\"format\"", "format").find("no JSON"), std::string::npos);
}

TEST(AttributionText, CallsAMapAMap) {
  EXPECT_EQ(attribution_text(test_manifest({test_source("scans", "mapper")})).rfind("This map was made from:\n", 0), 0u);
  EXPECT_EQ(attribution_text(test_manifest({test_source("scans", "mapper"), test_source("houses", "osm")})).rfind("This prior was made from:\n", 0), 0u);
}

}  // namespace
}  // namespace priormap
