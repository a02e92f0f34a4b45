#include <priormap/prior/prior_lookup.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <list>
#include <mutex>

#include <priormap/core/error.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/geodesy/crs.hpp>
#include <priormap/pointcloud/estimate_normals.hpp>
#include <priormap/pointcloud/slope.hpp>

#include "tile_cells.hpp"

namespace priormap {
namespace {

using SharedCells = std::shared_ptr<const TileCells>;

/// The tiles touched last. Each is brought in by whoever asks first; others who want it wait.
class TileCache {
 public:
  template <class Bring>
  SharedCells get(TileKey key, Bring&& bring) {
    std::promise<SharedCells> promise;
    bool is_mine = false;
    const std::shared_future<SharedCells> cells = find_or_add(key, promise, is_mine);
    if (is_mine) {
      try {
        promise.set_value(bring());
      } catch (...) {
        promise.set_exception(std::current_exception());
      }
    }
    return cells.get();
  }
  void forget(TileKey key) {
    const std::lock_guard lock(mutex_);
    std::erase_if(held_, [&](const Held& held) { return held.key == key; });
  }

 private:
  static constexpr std::size_t most_held = 12;
  struct Held {
    TileKey key;
    std::shared_future<SharedCells> cells;
  };

  std::shared_future<SharedCells> find_or_add(TileKey key, std::promise<SharedCells>& promise, bool& added) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(held_.begin(), held_.end(), [&](const Held& held) { return held.key == key; });
    added = found == held_.end();
    if (added)
      held_.push_front({key, promise.get_future().share()});
    else
      held_.splice(held_.begin(), held_, found);
    const std::shared_future<SharedCells> cells = held_.front().cells;
    if (held_.size() > most_held) held_.pop_back();
    return cells;
  }

  std::mutex mutex_;
  std::list<Held> held_;   // touched last in front
};

/// Low roofs of guessed heights would pass for ground.
void leave_out_roofs(PointCloud& points) {
  if (points.classification.empty()) return;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (points.classification[i] != static_cast<std::uint8_t>(PointClass::building) || is_wall(points.normal[i].z())) kept.push_back(i);
  if (kept.size() < points.size()) points = points.select(kept);
}

}  // namespace

PatchCloud patches_of_cell(PointCloud points, const PriorUnits& units) {
  const Eigen::Vector3f metres = Eigen::Vector3d(units.horizontal_m, units.horizontal_m, units.vertical_m).cast<float>();
  for (Eigen::Vector3f& p : points.xyz) p = p.cwiseProduct(metres).eval();
  estimate_normals(points);
  leave_out_roofs(points);
  return reduce_to_patches(points, lookup_voxel_m);
}

PriorUnits units_of(const PriorManifest& manifest) {
  if (manifest.crs.empty()) return {};
  const Crs crs = Crs::parse(manifest.crs);
  return {crs.horizontal_unit_m(), crs.vertical_unit_m()};
}

struct PriorLookup::Impl {
  const PriorStore& store;
  PriorUnits units;
  CellGrid grid;
  TileCache cache;
  mutable std::mutex making;   // one tile at a time: it takes more memory than all the rest

  std::filesystem::path file(TileKey tile) const { return store.directory() / lookup_folder_name / (TileGrid::name(tile) + ".cells"); }
  SharedCells open(const TileEntry& tile) const { return TileCells::open(file(tile.key), store, tile, grid, units); }
  SharedCells make(const TileEntry& tile) const { return std::make_shared<const TileCells>(store, tile, grid, units); }

  /// Mapped rather than in memory where the file can be written.
  SharedCells make_and_keep(const TileEntry& tile) const {
    const std::lock_guard one_at_a_time(making);
    SharedCells made = make(tile);
    try {
      made->write(file(tile.key));
      if (SharedCells mapped = open(tile)) return mapped;
    } catch (const IoError&) {
    }
    return made;
  }
  SharedCells open_or_make(const TileEntry& tile) const {
    SharedCells opened = open(tile);
    return opened ? opened : make_and_keep(tile);
  }
  TileEntry entry(TileKey tile) const {
    const std::optional<TileEntry> found = store.index().find(tile);
    if (!found) throw FormatError(store.directory(), "has no tile " + TileGrid::name(tile));
    return *found;
  }

  template <class Read>
  auto read(TileKey cell, Read&& read_from) {
    const TileKey tile = grid.tile_of(cell);
    const int number = grid.number_in_tile(cell);
    try {
      return read_from(*cache.get(tile, [&] { return open_or_make(entry(tile)); }), number);
    } catch (const DamagedCell&) {
      cache.forget(tile);
      return read_from(*cache.get(tile, [&] { return make_and_keep(entry(tile)); }), number);
    }
  }

  bool has_sound_file(const TileEntry& tile) const {
    const SharedCells cells = open(tile);
    return cells && cells->is_whole();
  }
};

PriorLookup::PriorLookup(const PriorStore& store, const PriorUnits& units) : impl_(new Impl{store, units, CellGrid(store.manifest().tile_size), {}, {}}) {}
PriorLookup::~PriorLookup() = default;
PriorLookup::PriorLookup(PriorLookup&&) noexcept = default;

const CellGrid& PriorLookup::grid() const { return impl_->grid; }

std::vector<TileKey> PriorLookup::cells_within(const Bounds2& bounds) const {
  const TileGrid cells = impl_->grid.as_tiles();
  std::vector<TileKey> keys;
  for (const TileKey tile : impl_->store.tiles_within(bounds))
    for (int number = 0; number < impl_->grid.cells_a_tile(); ++number) {
      const TileKey cell = impl_->grid.cell(tile, number);
      const Bounds2 b = cells.bounds(cell);
      if (b.min_x <= bounds.max_x && b.max_x > bounds.min_x && b.min_y <= bounds.max_y && b.max_y > bounds.min_y) keys.push_back(cell);
    }
  std::sort(keys.begin(), keys.end());
  return keys;
}

PatchCloud PriorLookup::patches(TileKey cell) const {
  return impl_->read(cell, [](const TileCells& cells, int number) { return cells.patches(number); });
}

PointCloud PriorLookup::points(TileKey cell) const {
  return impl_->read(cell, [](const TileCells& cells, int number) { return cells.points(number); });
}

std::size_t PriorLookup::make_files(int threads, const Events& events) const {
  const std::size_t count = impl_->store.index().size();
  std::atomic<std::size_t> made = 0;
  ordered_pipeline(
      count, threads, std::size_t(threads) * 2,
      [&](std::size_t i) {
        const TileEntry tile = impl_->store.index().entry(i);
        if (impl_->has_sound_file(tile)) return;
        impl_->make(tile)->write(impl_->file(tile.key));
        ++made;
      },
      [&](std::size_t i) { events.advance("making the lookup", double(i + 1) / double(count)); });
  return made;
}

}  // namespace priormap
