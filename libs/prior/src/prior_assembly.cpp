#include "prior_assembly.hpp"

#include <algorithm>
#include <numeric>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/core/output_file.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/pointcloud/las.hpp>

#include "point_order.hpp"
#include "record_columns.hpp"

namespace priormap {
namespace {

/// Distributes the points of one cloud: points in a row that share a tile go to the spool together.
class TileRuns {
 public:
  TileRuns(const LatticeGrid& grid, std::int64_t halo_steps, TileSpool& spool) : grid_(grid), halo_(halo_steps), spool_(spool) {}

  void add(PointRecord record, std::int64_t x, std::int64_t y) {
    if (run_.empty() || x < low_x_ || y < low_y_ || x >= low_x_ + grid_.tile_steps() || y >= low_y_ + grid_.tile_steps())
      start(grid_.key(x, y));
    record.x = std::int32_t(x - low_x_);
    record.y = std::int32_t(y - low_y_);
    run_.push_back(record);
    if (is_near_edge(record)) add_halo(record, x, y);
  }
  void flush() {
    if (!run_.empty()) spool_.add(key_, run_);
    run_.clear();
  }

 private:
  void start(TileKey key) {
    flush();
    key_ = key;
    low_x_ = grid_.origin(key.x);
    low_y_ = grid_.origin(key.y);
  }

  bool is_near_edge(const PointRecord& p) const {
    const std::int64_t last = grid_.tile_steps() - 1 - halo_;
    return halo_ > 0 && (p.x < halo_ || p.y < halo_ || p.x > last || p.y > last);
  }

  void add_halo(PointRecord record, std::int64_t x, std::int64_t y) {
    const TileKey low = grid_.key(x - halo_, y - halo_), high = grid_.key(x + halo_, y + halo_);
    record.halo = 1;
    for (TileKey key = low; key.x <= high.x; ++key.x)
      for (key.y = low.y; key.y <= high.y; ++key.y) {
        if (key == key_) continue;
        record.x = std::int32_t(x - grid_.origin(key.x));
        record.y = std::int32_t(y - grid_.origin(key.y));
        spool_.add(key, {&record, 1});
      }
  }

  const LatticeGrid& grid_;
  std::int64_t halo_;
  TileSpool& spool_;
  TileKey key_;
  std::int64_t low_x_ = 0, low_y_ = 0;
  std::vector<PointRecord> run_;
};

/// Where each source goes when they are in order of precedence, then id.
std::vector<std::uint16_t> order_sources(std::vector<PriorSource>& sources) {
  std::vector<std::uint16_t> order(sources.size());
  std::iota(order.begin(), order.end(), std::uint16_t(0));
  std::sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
    return std::tie(sources[a].precedence, sources[a].id) < std::tie(sources[b].precedence, sources[b].id);
  });
  std::vector<std::uint16_t> index(sources.size());
  std::vector<PriorSource> ordered;
  for (std::size_t i = 0; i < order.size(); ++i) {
    index[order[i]] = std::uint16_t(i);
    ordered.push_back(std::move(sources[order[i]]));
  }
  sources = std::move(ordered);
  return index;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  OutputFile out(file);
  out << text;
  out.close();
}

std::string checked_wkt1(const std::string& crs_text) {
  if (crs_text.empty()) return "";
  const Crs crs = Crs::parse(crs_text);
  if (!crs.is_projected())
    throw CrsError("a prior is stored in a projected CRS, and " + crs_text + " is none; choose one with --crs, such as EPSG:25832");
  return crs.wkt1();
}

std::optional<std::string> vertical_name(const std::string& crs_text) {
  if (crs_text.empty()) return std::nullopt;
  const std::optional<Crs> vertical = Crs::parse(crs_text).vertical();
  return vertical ? std::optional(vertical->name()) : std::nullopt;
}

}  // namespace

struct PriorAssembly::TileResult {
  TileEntry entry;
  Eigen::Vector3d min, max;
};

PriorAssembly::PriorAssembly(const std::filesystem::path& directory, PriorManifest manifest, Overwrite overwrite,
                             std::size_t memory_bytes, double halo)
    : directory_(directory, overwrite, manifest_file_name),
      manifest_(std::move(manifest)),
      grid_(manifest_.tile_size),
      wkt1_(checked_wkt1(manifest_.crs)),
      halo_steps_(to_lattice(halo)),
      tiles_(directory_.temporary_path(), memory_bytes),
      features_(directory_.temporary_path()) {
  manifest_.vertical = vertical_name(manifest_.crs);
}

template <class Position>
void PriorAssembly::add_each(const PointCloud& columns, const Position& position) {
  columns.check_columns();
  mark_features(columns);
  const RecordColumns records(columns);
  TileRuns runs(grid_, halo_steps_, tiles_);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Eigen::Vector3d p = position(i);
    PointRecord record = records.record(i);
    record.z = to_height_mm(p.z());
    if (record.source >= manifest_.sources.size())
      throw Error("a point names source " + std::to_string(record.source) + ", which the prior does not hold");
    runs.add(record, to_lattice(p.x()), to_lattice(p.y()));
  }
  runs.flush();
}

void PriorAssembly::add(const PointCloud& points) {
  add_each(points, [&](std::size_t i) { return points.position(i); });
}

void PriorAssembly::add(const PointCloud& columns, std::span<const Eigen::Vector3d> positions) {
  add_each(columns, [&](std::size_t i) -> const Eigen::Vector3d& { return positions[i]; });
}

void PriorAssembly::mark_features(const PointCloud& points) {
  std::vector<std::uint32_t> numbers;
  std::uint32_t last = PointCloud::no_feature;
  for (const std::uint32_t number : points.feature)
    if (number != last && number != PointCloud::no_feature) numbers.push_back(last = number);
  if (!numbers.empty()) features_.mark_used(numbers);
}

std::uint32_t PriorAssembly::add_feature(const Feature& feature) { return features_.add(feature); }

void PriorAssembly::set_sources(std::vector<PriorSource> sources) {
  if (sources.size() < manifest_.sources.size()) throw Error("sources of a prior cannot be taken away while it is written");
  manifest_.sources = std::move(sources);
}

void PriorAssembly::renumber(std::vector<PointRecord>& points) const {
  for (PointRecord& p : points) {
    p.source = source_index_[p.source];
    if (p.feature != PointCloud::no_feature) p.feature = feature_index_[p.feature];
  }
}

PriorAssembly::TileResult PriorAssembly::write_tile(TileKey key, const TileFilter& filter) {
  std::vector<PointRecord> points = tiles_.take(key);
  if (filter) filter(key, points);
  std::erase_if(points, [](const PointRecord& p) { return p.halo != 0; });
  renumber(points);
  sort_and_unite(points);

  TileResult result;
  result.entry.key = key;
  result.entry.num_points = points.size();
  if (points.empty()) return result;

  const PointCloud cloud = cloud_of(points, {grid_.origin(key.x), grid_.origin(key.y)});
  const std::vector<std::byte> bytes =
      encode_las(cloud, {.offset = {cloud.origin.x(), cloud.origin.y(), 0.0}, .wkt = wkt1_});
  OutputFile out(directory_.temporary_path() / tiles_folder_name / (TileGrid::name(key) + ".las"));
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  out.close();
  Sha256 hash;
  hash.update(bytes);
  result.entry.num_bytes = bytes.size();
  result.entry.sha256 = hash.hex_digest();

  Eigen::Array3i low = {points[0].x, points[0].y, points[0].z}, high = low;
  for (const PointRecord& p : points) {
    low = low.min(Eigen::Array3i(p.x, p.y, p.z));
    high = high.max(Eigen::Array3i(p.x, p.y, p.z));
  }
  const Eigen::Array3d corner(double(grid_.origin(key.x)), double(grid_.origin(key.y)), 0);
  result.min = (low.cast<double>() + corner) / 1000.0;
  result.max = (high.cast<double>() + corner) / 1000.0;
  result.entry.min_z = float(result.min.z());
  result.entry.max_z = float(result.max.z());
  return result;
}

PriorManifest PriorAssembly::finish(int threads, const Events& events, const TileFilter& filter) {
  const std::filesystem::path& folder = directory_.temporary_path();
  const FeatureSpool::Written features = features_.write(folder / features_file_name, manifest_.crs, threads);
  feature_index_ = features.index_of_number;
  manifest_.num_features = features.count;
  manifest_.features_crs = features.crs;
  manifest_.features_sha256 = features.sha256;
  source_index_ = order_sources(manifest_.sources);

  std::filesystem::create_directory(folder / tiles_folder_name);
  const std::vector<TileKey> keys = tiles_.keys();
  std::vector<TileResult> results(keys.size());
  std::vector<TileEntry> entries;
  manifest_.num_points = 0;
  ordered_pipeline(
      keys.size(), threads, std::size_t(threads) * 4, [&](std::size_t i) { results[i] = write_tile(keys[i], filter); },
      [&](std::size_t i) {
        TileResult& result = results[i];
        if (result.entry.num_points != 0) {
          const bool first = entries.empty();
          manifest_.min = first ? result.min : Eigen::Vector3d(manifest_.min.cwiseMin(result.min));
          manifest_.max = first ? result.max : Eigen::Vector3d(manifest_.max.cwiseMax(result.max));
          manifest_.num_points += result.entry.num_points;
          entries.push_back(std::move(result.entry));
        }
        events.advance("writing tiles", double(i + 1) / double(keys.size()));
      });

  manifest_.num_tiles = entries.size();
  manifest_.tiles = write_tile_index(folder / tile_index_file_name, entries);
  write_text(folder / attribution_file_name, attribution_text(manifest_));
  write_text(folder / manifest_file_name, manifest_json(manifest_));
  directory_.commit();
  return manifest_;
}

}  // namespace priormap
