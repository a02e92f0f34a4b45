#include "prior_assembly.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
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

/// Points of a cloud on the lattice, not yet in tiles.
struct Block {
  static constexpr std::size_t capacity = 256;   ///< stays in the fastest cache
  std::array<PointRecord, capacity> records;
  std::array<std::int64_t, capacity> x, y;
};

/// Distributes points: those in a row that share a tile go to the spool together.
class TileDistributor {
 public:
  TileDistributor(const LatticeGrid& grid, std::int64_t halo_steps, TileSpool& spool) : grid_(grid), halo_(halo_steps), spool_(spool) {}

  /// @param x, y  of record i on the lattice, asked for before the record gets its own
  template <class X, class Y>
  void add(std::span<PointRecord> records, const X& x, const Y& y) const {
    for (std::size_t first = 0; first < records.size();) {
      const TileKey key = grid_.key(x(first), y(first));
      const std::int64_t low_x = grid_.origin(key.x), low_y = grid_.origin(key.y);
      const auto size = std::uint64_t(grid_.tile_steps());
      std::size_t last = first;
      for (; last < records.size(); ++last) {
        const std::int64_t dx = x(last) - low_x, dy = y(last) - low_y;
        if (std::uint64_t(dx) >= size || std::uint64_t(dy) >= size) break;
        records[last].x = std::int32_t(dx);
        records[last].y = std::int32_t(dy);
        if (halo_ > 0 && is_near_edge(dx, dy)) add_halo(records[last], dx + low_x, dy + low_y, key);
      }
      spool_.add(key, records.subspan(first, last - first));
      first = last;
    }
  }

 private:
  bool is_near_edge(std::int64_t dx, std::int64_t dy) const {
    const std::int64_t last = grid_.tile_steps() - 1 - halo_;
    return dx < halo_ || dy < halo_ || dx > last || dy > last;
  }

  void add_halo(PointRecord record, std::int64_t x, std::int64_t y, TileKey own) const {
    const TileKey low = grid_.key(x - halo_, y - halo_), high = grid_.key(x + halo_, y + halo_);
    mark_halo(record);
    for (TileKey key = low; key.x <= high.x; ++key.x)
      for (key.y = low.y; key.y <= high.y; ++key.y) {
        if (key == own) continue;
        record.x = std::int32_t(x - grid_.origin(key.x));
        record.y = std::int32_t(y - grid_.origin(key.y));
        spool_.add(key, {&record, 1});
      }
  }

  const LatticeGrid& grid_;
  std::int64_t halo_;
  TileSpool& spool_;
};

/// The features of points, each as often as it begins anew.
template <class Points, class FeatureOf>
std::vector<std::uint32_t> in_a_row(const Points& points, const FeatureOf& feature_of) {
  std::vector<std::uint32_t> numbers;
  std::uint32_t last = PointCloud::no_feature;
  for (const auto& point : points)
    if (const std::uint32_t number = feature_of(point); number != last && number != PointCloud::no_feature) numbers.push_back(last = number);
  return numbers;
}

/// Where each source goes when they are in order of precedence, then id.
std::vector<std::uint16_t> order_of(const std::vector<PriorSource>& sources) {
  std::vector<std::uint16_t> order(sources.size());
  std::iota(order.begin(), order.end(), std::uint16_t(0));
  std::sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
    return std::tie(sources[a].precedence, sources[a].id) < std::tie(sources[b].precedence, sources[b].id);
  });
  std::vector<std::uint16_t> index(sources.size());
  for (std::size_t i = 0; i < order.size(); ++i) index[order[i]] = std::uint16_t(i);
  return index;
}

std::vector<PriorSource> ordered(std::vector<PriorSource> sources, const std::vector<std::uint16_t>& index) {
  std::vector<PriorSource> result(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) result[index[i]] = std::move(sources[i]);
  return result;
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

PriorAssembly::PriorAssembly(const std::filesystem::path& directory, PriorManifest manifest, Overwrite overwrite,
                             std::size_t memory_bytes, double halo)
    : directory_(directory, overwrite, manifest_file_name),
      manifest_(std::move(manifest)),
      grid_(manifest_.tile_size),
      wkt1_(checked_wkt1(manifest_.crs)),
      halo_steps_(to_lattice(halo)),
      tiles_(directory_.temporary_path(), memory_bytes),
      features_(directory_.temporary_path()),
      source_index_(order_of(manifest_.sources)) {
  manifest_.vertical = vertical_name(manifest_.crs);
  std::filesystem::create_directory(directory_.temporary_path() / tiles_folder_name);
}

template <class Position>
void PriorAssembly::add_each(const PointCloud& columns, const Position& position) {
  columns.check_columns();
  if (!columns.source.empty()) check_source(*std::ranges::max_element(columns.source));
  features_.mark_used(in_a_row(columns.feature, [](std::uint32_t feature) { return feature; }));
  const TileDistributor tiles(grid_, halo_steps_, tiles_);
  const auto block = std::make_unique<Block>();
  for (std::size_t first = 0; first < columns.size(); first += Block::capacity) {
    const std::size_t count = std::min(Block::capacity, columns.size() - first);
    fill_columns(columns, first, std::span(block->records).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d p = position(first + i);
      block->x[i] = to_lattice(p.x());
      block->y[i] = to_lattice(p.y());
      block->records[i].z = to_height_mm(p.z());
    }
    tiles.add(std::span(block->records).first(count), [&](std::size_t i) { return block->x[i]; }, [&](std::size_t i) { return block->y[i]; });
  }
}

void PriorAssembly::add(LatticePoint corner, std::span<PointRecord> points) {
  std::uint16_t largest_source = 0;
  for (const PointRecord& p : points) largest_source = std::max(largest_source, p.source);
  check_source(largest_source);
  features_.mark_used(in_a_row(points, [](const PointRecord& p) { return p.feature; }));
  TileDistributor(grid_, halo_steps_, tiles_).add(points, [&](std::size_t i) { return corner.x + points[i].x; }, [&](std::size_t i) { return corner.y + points[i].y; });
}

void PriorAssembly::add(const PointCloud& points) {
  add_each(points, [&](std::size_t i) { return points.position(i); });
}

void PriorAssembly::add(const PointCloud& columns, std::span<const Eigen::Vector3d> positions) {
  add_each(columns, [&](std::size_t i) -> const Eigen::Vector3d& { return positions[i]; });
}

void PriorAssembly::check_source(std::size_t largest) const {
  if (largest >= manifest_.sources.size()) throw Error("a point names source " + std::to_string(largest) + ", which the prior does not hold");
}

std::uint32_t PriorAssembly::add_feature(const Feature& feature) { return features_.add(feature); }

void PriorAssembly::set_sources(std::vector<PriorSource> sources) {
  if (sources.size() < manifest_.sources.size()) throw Error("sources of a prior cannot be taken away while it is written");
  std::vector<std::uint16_t> index = order_of(sources);
  if (!closed_.empty() && index != source_index_) throw Error("sources of a prior cannot change places once a tile is closed");
  manifest_.sources = std::move(sources);
  source_index_ = std::move(index);
}

void PriorAssembly::renumber(std::vector<PointRecord>& points) const {
  if (features_.empty() && std::ranges::is_sorted(source_index_)) return;   // a permutation: each keeps its number
  for (PointRecord& p : points) {
    p.source = source_index_[p.source];
    if (p.feature == PointCloud::no_feature) continue;
    if (p.feature >= feature_index_.size()) throw Error("a tile with features cannot be closed before the prior is finished");
    p.feature = feature_index_[p.feature];
  }
}

PriorAssembly::TileResult PriorAssembly::write_tile(TileKey key, const TileFilter& filter) {
  constexpr std::size_t large = std::size_t(1) << 20;   // 32 MB, and more again to sort them
  std::unique_lock alone(large_tile_mutex_, std::defer_lock);
  std::shared_lock beside_others(large_tile_mutex_, std::defer_lock);
  if (tiles_.count(key) > large)
    alone.lock();
  else
    beside_others.lock();
  std::vector<PointRecord> points = tiles_.take(key);
  if (filter) filter(key, points);
  if (halo_steps_ > 0) std::erase_if(points, is_halo);
  renumber(points);
  std::vector<PointRecord> spare = tiles_.spare();
  sort_and_unite(points, spare);
  tiles_.recycle(std::move(spare));

  TileResult result;
  result.entry.key = key;
  result.entry.num_points = points.size();
  if (points.empty()) return result;

  const Eigen::Array3d corner(double(grid_.origin(key.x)), double(grid_.origin(key.y)), 0);
  OutputFile out(directory_.temporary_path() / tiles_folder_name / (TileGrid::name(key) + ".las"));
  Sha256 hash;
  const Eigen::AlignedBox3i extent = encode_las(points, {.offset = corner / 1000.0, .wkt = wkt1_}, [&](std::span<const std::byte> bytes) {
    hash.update(bytes);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    result.entry.num_bytes += bytes.size();
  });
  out.close();
  result.entry.sha256 = hash.hex_digest();
  tiles_.recycle(std::move(points));

  result.min = (extent.min().array().cast<double>() + corner) / 1000.0;
  result.max = (extent.max().array().cast<double>() + corner) / 1000.0;
  result.entry.min_z = float(result.min.z());
  result.entry.max_z = float(result.max.z());
  return result;
}

void PriorAssembly::close_tile(TileKey key, const TileFilter& filter) {
  TileResult tile = write_tile(key, filter);
  if (tile.entry.num_points == 0) return;
  const std::lock_guard lock(closed_mutex_);
  if (!closed_.emplace(key, std::move(tile)).second) throw Error("points were added to a closed tile of the prior");
}

/// Of the tiles, all around their points.
Bounds2 PriorAssembly::extent() const {
  std::vector<TileKey> keys = tiles_.keys();
  for (const auto& [key, tile] : closed_) keys.push_back(key);
  Eigen::AlignedBox2d box;
  for (const TileKey key : keys)
    for (const int corner : {0, 1}) box.extend(1e-3 * Eigen::Vector2d(double(grid_.origin(key.x + corner)), double(grid_.origin(key.y + corner))));
  return {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
}

PriorManifest PriorAssembly::finish(int threads, const Events& events, const TileFilter& filter) {
  const std::filesystem::path& folder = directory_.temporary_path();
  manifest_.sources = ordered(std::move(manifest_.sources), source_index_);
  const FeatureSpool::Written features = features_.write(folder / features_file_name, manifest_, extent(), threads);
  feature_index_ = features.index_of_number;
  manifest_.num_features = features.count;
  manifest_.features_crs = features.crs;
  manifest_.features_operation = features.operation;
  manifest_.features_sha256 = features.sha256;

  const std::vector<TileKey> keys = tiles_.keys();
  std::atomic<std::size_t> done = 0;
  parallel_for(keys.size(), threads, [&](std::size_t i) {
    close_tile(keys[i], filter);
    events.advance("writing tiles", double(++done) / double(keys.size()));
  });

  std::vector<TileEntry> entries;
  manifest_.num_points = 0;
  for (auto& [key, tile] : closed_) {
    const bool first = entries.empty();
    manifest_.min = first ? tile.min : Eigen::Vector3d(manifest_.min.cwiseMin(tile.min));
    manifest_.max = first ? tile.max : Eigen::Vector3d(manifest_.max.cwiseMax(tile.max));
    manifest_.num_points += tile.entry.num_points;
    entries.push_back(std::move(tile.entry));
  }

  manifest_.num_tiles = entries.size();
  manifest_.tiles = write_tile_index(folder / tile_index_file_name, entries);
  write_text(folder / attribution_file_name, attribution_text(manifest_));
  write_text(folder / manifest_file_name, manifest_json(manifest_));
  directory_.commit();
  return manifest_;
}

}  // namespace priormap
