#pragma once
#include <functional>
#include <map>
#include <mutex>
#include <shared_mutex>
#include <span>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/prior/prior_manifest.hpp>
#include <priormap/prior/prior_writer.hpp>

#include "feature_spool.hpp"
#include "lattice.hpp"
#include "tile_spool.hpp"

namespace priormap {

/// A prior in the making: what PriorWriter and merging share. `add` and `add_feature` are thread-safe.
class PriorAssembly {
 public:
  /// @param halo  points up to this far outside a tile are also given to it, marked as halo, as witnesses for the `TileFilter`
  PriorAssembly(const std::filesystem::path& directory, PriorManifest manifest, Overwrite overwrite, std::size_t memory_bytes,
                double halo = 0);

  void add(const PointCloud& points);
  /// The columns of a cloud at other positions, one a point.
  void add(const PointCloud& columns, std::span<const Eigen::Vector3d> positions);
  /// As PriorWriter::add.
  void add(LatticePoint corner, std::span<PointRecord> points);
  std::uint32_t add_feature(const Feature& feature);
  void set_sources(std::vector<PriorSource> sources);
  /// As PriorWriter::close_tile.
  void close_tile(TileKey key) { close_tile(key, {}); }

  /// May remove points of a tile. They come in no order, halo included, with the numbers of features and sources they were added
  /// with. Whether a point stays must depend on the set of points around it alone. Called from several threads.
  using TileFilter = std::function<void(TileKey, std::vector<PointRecord>&)>;
  PriorManifest finish(int threads, const Events& events, const TileFilter& filter = {});

 private:
  struct TileResult {
    TileEntry entry;
    Eigen::Vector3d min = Eigen::Vector3d::Zero(), max = Eigen::Vector3d::Zero();
  };
  void close_tile(TileKey key, const TileFilter& filter);
  TileResult write_tile(TileKey key, const TileFilter& filter);
  template <class Position>
  void add_each(const PointCloud& columns, const Position& position);
  Bounds2 extent() const;
  void check_source(std::size_t largest) const;
  void renumber(std::vector<PointRecord>& points) const;

  AtomicDirectory directory_;
  PriorManifest manifest_;
  LatticeGrid grid_;
  std::string wkt1_;
  std::int64_t halo_steps_;
  TileSpool tiles_;
  FeatureSpool features_;
  std::vector<std::uint32_t> feature_index_;   ///< of the number that add_feature gave; known at the end
  std::vector<std::uint16_t> source_index_;    ///< of the position in the sources as they were given
  std::mutex closed_mutex_;
  std::shared_mutex large_tile_mutex_;   ///< held alone by a large tile, shared by others
  std::map<TileKey, TileResult> closed_;
};

}  // namespace priormap
