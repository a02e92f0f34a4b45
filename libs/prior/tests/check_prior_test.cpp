#include <priormap/prior/check_prior.hpp>

#include <algorithm>

#include "test_prior.hpp"

namespace priormap {
namespace {

void write_prior(const std::filesystem::path& directory, const std::string& crs = "EPSG:25832") {
  PriorWriter writer(directory, test_manifest({test_source("a")}, 50, crs), Overwrite::refuse);
  PointCloud cloud = random_cloud(500, 1, 120, {691'000, 5'336'000, 0});
  cloud.feature.assign(cloud.size(), writer.add_feature({.source = "a", .id = "way/1"}));
  writer.add(cloud);
  writer.finish(2);
}

void change(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::string text = file_text(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  std::ofstream(file, std::ios::binary) << text.replace(at, from.size(), to);
}

/// The faults after something was done to a whole prior.
template <class Damage>
std::vector<std::string> faults_after(const Damage& damage) {
  const TestFolder folder;
  write_prior(folder / "prior");
  damage(folder / "prior");
  return check_prior(folder / "prior", 2);
}

bool names(const std::vector<std::string>& faults, const std::string& text) {
  return std::ranges::any_of(faults, [&](const std::string& fault) { return fault.find(text) != std::string::npos; });
}

TEST(CheckPrior, AWholePriorHasNoFault) {
  for (const std::string crs : {"", "EPSG:25832", "EPSG:25832+7837"}) {
    const TestFolder folder;
    write_prior(folder / "prior", crs);
    EXPECT_EQ(check_prior(folder / "prior", 2), std::vector<std::string>()) << crs;
  }
}

TEST(CheckPrior, NamesEachFault) {
  using Path = std::filesystem::path;
  const Path tile = "tiles/13820_106720.las";
  EXPECT_TRUE(names(faults_after([&](const Path& p) { std::filesystem::remove(p / tile); }), tile.string()));
  EXPECT_TRUE(names(faults_after([&](const Path& p) { std::filesystem::resize_file(p / tile, 700); }), "sha256"));
  EXPECT_TRUE(names(faults_after([&](const Path& p) { std::ofstream(p / "tiles/stranger.las") << "x"; }), "stranger.las"));
  EXPECT_TRUE(names(faults_after([](const Path& p) { std::filesystem::remove(p / "features.geojsonl"); }), "features.geojsonl"));
  EXPECT_TRUE(names(faults_after([](const Path& p) { change(p / "features.geojsonl", "way/1", "way/2"); }), "features.geojsonl"));
  EXPECT_TRUE(names(faults_after([](const Path& p) { std::filesystem::resize_file(p / "tiles.idx", 100); }), "tiles.idx: is cut short"));
  EXPECT_TRUE(names(faults_after([](const Path& p) { std::filesystem::remove(p / "ATTRIBUTION.txt"); }), "ATTRIBUTION.txt"));
  EXPECT_TRUE(names(faults_after([](const Path& p) { std::filesystem::remove(p / "prior.json"); }), "prior.json"));
  const auto manifest_fault = [](const std::string& from, const std::string& to) {
    return faults_after([&](const Path& p) { change(p / "prior.json", from, to); });
  };
  EXPECT_TRUE(names(manifest_fault("\"EPSG:25832\"", "\"EPSG:25833\""), "has another CRS than prior.json"));
  EXPECT_TRUE(names(manifest_fault("\"EPSG:25832\"", "\"EPSG:4326\""), "is not projected"));
  EXPECT_TRUE(names(manifest_fault("\"EPSG:25832\"", "\"EPSG:1\""), "EPSG:1"));
  EXPECT_TRUE(names(manifest_fault("\"vertical\": null", "\"vertical\": \"EPSG:7837\""), "vertical: EPSG:7837"));
  EXPECT_TRUE(names(manifest_fault("\"num_points\": 500", "\"num_points\": 501"), "501"));
  EXPECT_TRUE(names(manifest_fault("\"tile_size\": 50.0", "\"tile_size\": 60.0"), "holds a point outside the tile"));
  EXPECT_TRUE(names(manifest_fault("\"min\": [\n      69", "\"min\": [\n      59"), "bounds"));
}

TEST(CheckPrior, OneFaultDoesNotHideAnother) {
  const auto faults = faults_after([](const std::filesystem::path& p) {
    std::filesystem::remove(p / "ATTRIBUTION.txt");
    std::filesystem::remove(p / "tiles/13820_106720.las");
    std::filesystem::remove(p / "tiles/13821_106720.las");
  });
  EXPECT_EQ(faults.size(), 3u);
}

}  // namespace
}  // namespace priormap
