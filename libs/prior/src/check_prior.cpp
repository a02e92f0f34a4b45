#include <priormap/prior/check_prior.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/pointcloud/las.hpp>
#include <priormap/prior/prior_store.hpp>

#include "lattice.hpp"

namespace priormap {
namespace {

using Faults = std::vector<std::string>;

/// Runs one check; what it throws is a fault.
template <class Check>
void collect(Faults& faults, const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    faults.push_back(error.what());
  }
}

void expect(bool holds, const std::filesystem::path& file, const std::string& fault) {
  if (!holds) throw FormatError(file, fault);
}

void check_crs(const PriorStore& prior) {
  const std::filesystem::path file = prior.directory() / manifest_file_name;
  const PriorManifest& manifest = prior.manifest();
  if (manifest.crs.empty()) return expect(!manifest.vertical, file, "vertical: a local metric frame has no vertical CRS");
  const Crs crs = Crs::parse(manifest.crs);
  expect(crs.is_projected(), file, "crs: " + manifest.crs + " is not projected");
  const std::optional<Crs> vertical = crs.vertical();
  const bool agree = manifest.vertical ? vertical && vertical->equivalent_to(Crs::parse(*manifest.vertical)) : !vertical;
  expect(agree, file, "vertical: " + manifest.vertical.value_or("null") + " is not the vertical part of " + manifest.crs);
}

void check_index(const PriorStore& prior) {
  const std::filesystem::path file = prior.directory() / tile_index_file_name;
  const PriorManifest& manifest = prior.manifest();
  expect(sha256_file(file) == manifest.tiles.file_sha256, file, "does not have the sha256 that prior.json states");
  std::uint64_t num_points = 0;
  std::optional<TileKey> last;
  for (const TileEntry entry : prior.tiles()) {
    expect(!last || *last < entry.key, file, "is not sorted at tile " + TileGrid::name(entry.key));
    last = entry.key;
    num_points += entry.num_points;
  }
  expect(num_points == manifest.num_points, file,
         "holds " + std::to_string(num_points) + " points, prior.json says " + std::to_string(manifest.num_points));
}

void check_features(const PriorStore& prior) {
  const std::filesystem::path file = prior.directory() / features_file_name;
  const PriorManifest& manifest = prior.manifest();
  expect(sha256_file(file) == manifest.features_sha256, file, "does not have the sha256 that prior.json states");
  std::set<std::string> sources;
  for (const PriorSource& source : manifest.sources) sources.insert(source.id);
  std::uint64_t count = 0;
  prior.for_each_feature([&](std::uint32_t index, const Feature& feature) {
    ++count;
    expect(sources.contains(feature.source), file,
           "feature " + std::to_string(index) + " names source \"" + feature.source + "\", which prior.json does not");
  });
  expect(count == manifest.num_features, file,
         "holds " + std::to_string(count) + " features, prior.json says " + std::to_string(manifest.num_features));
}

void check_attribution(const PriorStore& prior) {
  const std::filesystem::path file = prior.directory() / attribution_file_name;
  expect(std::filesystem::is_regular_file(file), file, "is missing; it goes with the data");
}

void check_surplus_tiles(const PriorStore& prior) {
  std::set<std::string> known;
  for (const TileEntry entry : prior.tiles()) known.insert(prior.tile_file(entry.key).filename().string());
  const std::filesystem::path folder = prior.directory() / tiles_folder_name;
  expect(std::filesystem::is_directory(folder), folder, "is missing");
  for (const auto& item : std::filesystem::directory_iterator(folder))
    expect(known.contains(item.path().filename().string()), item.path(), "is not in tiles.idx");
}

struct Extent {
  Eigen::Vector3d min = Eigen::Vector3d::Constant(INFINITY), max = Eigen::Vector3d::Constant(-INFINITY);
  void include(const Eigen::Vector3d& p) { min = min.cwiseMin(p), max = max.cwiseMax(p); }
  void include(const Extent& other) { include(other.min), include(other.max); }
};

/// One tile; its extent goes into that of the prior.
class TileCheck {
 public:
  TileCheck(const PriorStore& prior, const std::optional<Crs>& crs) : prior_(prior), crs_(crs), grid_(prior.manifest().tile_size) {}

  Extent run(const TileEntry& entry) const {
    const std::filesystem::path file = prior_.tile_file(entry.key);
    const PointCloud points = prior_.load(entry.key).points;
    check_header(file);
    Extent extent;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p = points.position(i);
      expect(grid_.key(to_lattice(p.x()), to_lattice(p.y())) == entry.key, file, "holds a point outside the tile");
      expect(points.source[i] < prior_.manifest().sources.size(), file,
             "names source " + std::to_string(points.source[i]) + ", which prior.json does not");
      expect(points.feature[i] == PointCloud::no_feature || points.feature[i] < prior_.manifest().num_features, file,
             "names feature " + std::to_string(points.feature[i]) + ", which features.geojsonl does not");
      extent.include(p);
    }
    const bool heights_agree = std::abs(extent.min.z() - entry.min_z) < 0.01 && std::abs(extent.max.z() - entry.max_z) < 0.01;
    expect(heights_agree, file, "has other heights than the index states");
    return extent;
  }

 private:
  void check_header(const std::filesystem::path& file) const {
    const std::string crs = LasReader(file).header().crs;
    if (!crs_) return expect(crs.empty(), file, "has a CRS in a prior without one");
    expect(!crs.empty(), file, "has no CRS");
    expect(Crs::parse(crs).horizontal().equivalent_to(crs_->horizontal()), file, "has another CRS than prior.json");
  }

  const PriorStore& prior_;
  const std::optional<Crs>& crs_;
  LatticeGrid grid_;
};

void check_tiles(const PriorStore& prior, int threads, const Events& events, Faults& faults) {
  const PriorManifest& manifest = prior.manifest();
  const std::optional<Crs> crs = manifest.crs.empty() ? std::nullopt : std::optional(Crs::parse(manifest.crs));
  const TileCheck check(prior, crs);
  const std::size_t count = prior.index().size();
  std::vector<Faults> faults_of_tile(count);
  std::vector<Extent> extents(count);
  Extent whole;
  ordered_pipeline(
      count, threads, std::size_t(threads) * 4,
      [&](std::size_t i) { collect(faults_of_tile[i], [&] { extents[i] = check.run(prior.index().entry(i)); }); },
      [&](std::size_t i) {
        faults.insert(faults.end(), faults_of_tile[i].begin(), faults_of_tile[i].end());
        whole.include(extents[i]);
        events.advance("checking tiles", double(i + 1) / double(count));
      });
  if (!faults.empty() || count == 0) return;
  const bool agrees = (whole.min - manifest.min).cwiseAbs().maxCoeff() < 0.01 && (whole.max - manifest.max).cwiseAbs().maxCoeff() < 0.01;
  if (!agrees) faults.push_back((prior.directory() / manifest_file_name).string() + ": bounds: are not those of the points");
}

}  // namespace

std::vector<std::string> check_prior(const std::filesystem::path& directory, int threads, const Events& events) {
  Faults faults;
  std::optional<PriorStore> prior;
  collect(faults, [&] { prior.emplace(directory); });
  if (!prior) return faults;
  collect(faults, [&] { check_crs(*prior); });
  collect(faults, [&] { check_index(*prior); });
  collect(faults, [&] { check_features(*prior); });
  collect(faults, [&] { check_attribution(*prior); });
  collect(faults, [&] { check_surplus_tiles(*prior); });
  collect(faults, [&] { check_tiles(*prior, threads, events, faults); });
  return faults;
}

}  // namespace priormap
