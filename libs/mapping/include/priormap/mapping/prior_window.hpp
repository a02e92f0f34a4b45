#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <type_traits>
#include <vector>

#include <priormap/core/parallel.hpp>
#include <priormap/core/state_archive.hpp>
#include <priormap/geodesy/map_frame.hpp>
#include <priormap/mapping/prior_points.hpp>
#include <priormap/mapping/tile_prefetch.hpp>

namespace priormap {

/// Points or patches of one tile brought from the prior's CRS into `map`, by one affine map a tile (0.1 mm over 50 m).
PointCloud tile_in_map(PointCloud tile, const PriorPoints& points, const MapFrame& frame);
PatchCloud tile_in_map(PatchCloud tile, const PriorPoints& points, const MapFrame& frame);

/// Which tiles of a prior are near the vehicle. `points` must outlive this.
class NearTiles {
 public:
  NearTiles(const PriorPoints& points, const MapFrame& frame, double radius_m, int threads = 1)
      : points_(&points), frame_(frame), radius_m_(radius_m), threads_(threads) {}

  /// Forgets tiles that are far now. @return the tiles that have come within the radius
  std::vector<TileKey> move_to(const Eigen::Vector3d& p_map);
  /// The tiles that would come within the radius there.
  std::vector<TileKey> lacking_at(const Eigen::Vector3d& p_map) const;
  /// No point of a tile that is held lies farther from the vehicle than this.
  double reach_m() const;
  const PriorPoints& points() const { return *points_; }
  const MapFrame& frame() const { return frame_; }
  int threads() const { return threads_; }   ///< to load with when much is lacking
  std::size_t count() const { return held_.size(); }
  void exchange(StateArchive& archive);

 private:
  double drop_m() const;
  std::vector<TileKey> within(const Eigen::Vector3d& p_map, double radius_m) const;

  const PriorPoints* points_;
  MapFrame frame_;
  double radius_m_;
  int threads_;
  std::set<TileKey> held_;
};

/// The prior around the vehicle in the frame `map`, as a map to match against (VoxelHashMap takes points, SurfelMap patches): tiles come in as the vehicle comes
/// near, read in the background before they are needed, and are dropped behind it. What it holds depends on the places asked for alone, not on timing.
template <class Map>
class PriorWindow {
  static constexpr bool takes_patches = requires(Map& map, const PatchCloud& patches) { map.insert(patches); };

 public:
  using Tile = std::conditional_t<takes_patches, PatchCloud, PointCloud>;
  PriorWindow(NearTiles tiles, Map empty, std::function<void(Tile&)> amend = {})
      : amend_(std::move(amend)), tiles_(std::move(tiles)), map_(std::move(empty)), prefetch_(std::make_unique<TilePrefetch<Tile>>([points = &tiles_.points(), frame = tiles_.frame()](TileKey key) { return tile_in_map(load(*points, key), *points, frame); })) {}

  /// Loads and drops, then returns what is there. @throws what loading a tile throws
  const Map& around(const Eigen::Vector3d& p_map) {
    const auto arrived = tiles_.move_to(p_map);
    if (!arrived.empty()) map_.remove_beyond(p_map, tiles_.reach_m());
    for (Tile& tile : bring(arrived)) {
      if (amend_) amend_(tile);
      map_.insert(tile);
    }
    look_ahead(p_map);
    return map_;
  }
  const Map& map() const { return map_; }   ///< as it is, without loading
  std::size_t tiles_held() const { return tiles_.count(); }
  /// What is there: it comes of the whole way so far.
  void exchange(StateArchive& archive) { archive(tiles_, map_); }

 private:
  static constexpr double ahead_m = 50;

  static Tile load(const PriorPoints& points, TileKey key) {
    if constexpr (takes_patches)
      return points.patches(key);
    else
      return points.load(key);
  }

  /// In `map`.
  std::vector<Tile> bring(const std::vector<TileKey>& keys) {
    std::vector<Tile> tiles(keys.size());
    std::vector<std::size_t> lacking;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (auto ready = prefetch_->take(keys[i]))
        tiles[i] = std::move(*ready);
      else
        lacking.push_back(i);
    }
    parallel_for(lacking.size(), tiles_.threads(), [&](std::size_t k) { tiles[lacking[k]] = load(tiles_.points(), keys[lacking[k]]); });
    for (const std::size_t i : lacking) tiles[i] = tile_in_map(std::move(tiles[i]), tiles_.points(), tiles_.frame());   // a frame is one thread's
    return tiles;
  }

  void look_ahead(const Eigen::Vector3d& p_map) {
    const Eigen::Vector3d motion = last_ ? Eigen::Vector3d(p_map - *last_) : Eigen::Vector3d::Zero();
    last_ = p_map;
    if (!motion.isZero()) prefetch_->wish(tiles_.lacking_at(p_map + ahead_m * motion.normalized()));
  }

  std::function<void(Tile&)> amend_;
  NearTiles tiles_;
  Map map_;
  std::unique_ptr<TilePrefetch<Tile>> prefetch_;
  std::optional<Eigen::Vector3d> last_;
};

}  // namespace priormap
