#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>

#include <priormap/prior/prior_store.hpp>
#include <priormap/prior/prior_writer.hpp>

namespace priormap {

/// An empty folder of the test's own.
class TestFolder {
 public:
  TestFolder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("priormap_" + std::string(info->test_suite_name()) + "_" + info->name() + "_" + std::to_string(::getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string file_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// All files below a folder by relative name.
inline std::map<std::string, std::string> folder_content(const std::filesystem::path& folder) {
  std::map<std::string, std::string> content;
  for (const auto& item : std::filesystem::recursive_directory_iterator(folder))
    if (item.is_regular_file()) content[item.path().lexically_relative(folder).string()] = file_text(item.path());
  return content;
}

inline PriorSource test_source(const std::string& id, const std::string& kind = "osm") {
  PriorSource source;
  source.id = id;
  source.kind = kind;
  source.file_name = id + ".osm.pbf";
  source.sha256 = std::string(64, '0');
  source.license = "ODbL-1.0";
  source.attribution = "OpenStreetMap contributors";
  source.crs = "EPSG:4326";
  return source;
}

inline PriorManifest test_manifest(std::vector<PriorSource> sources, double tile_size = 50, const std::string& crs = "") {
  PriorManifest manifest;
  manifest.crs = crs;
  manifest.tile_size = tile_size;
  manifest.sources = std::move(sources);
  manifest.generator = "test 1";
  return manifest;
}

/// Points all over a square, with every column, positions on the millimetre lattice.
inline PointCloud random_cloud(std::size_t n, unsigned seed, double extent_m, const Eigen::Vector3d& origin = {0, 0, 0}) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> horizontal(0, int(extent_m * 1000)), vertical(100'000, 130'000), step(-100, 100);
  PointCloud cloud;
  cloud.origin = origin;
  for (std::size_t i = 0; i < n; ++i) {
    cloud.xyz.emplace_back(float(horizontal(random) / 1000.0), float(horizontal(random) / 1000.0), float(vertical(random) / 1000.0));
    Eigen::Vector3f normal(float(step(random)), float(step(random)), 50.0f);
    cloud.normal.push_back(normal.normalized());
    cloud.classification.push_back(std::uint8_t(random() % 2 ? 6 : 2));
    cloud.sigma_m.push_back(0.25f);
    cloud.source.push_back(0);
    cloud.feature.push_back(PointCloud::no_feature);
  }
  return cloud;
}

}  // namespace priormap
