#pragma once
#include <functional>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/prior/prior_manifest.hpp>

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
  std::uint32_t add_feature(const Feature& feature);
  void set_sources(std::vector<PriorSource> sources);

  /// May remove points of a tile. They come united and sorted, halo included, with features and sources as they will be written.
  using TileFilter = std::function<void(TileKey, std::vector<PointRecord>&)>;
  PriorManifest finish(int threads, const Events& events, const TileFilter& filter = {});

 private:
  struct TileResult;
  TileResult write_tile(TileKey key, const TileFilter& filter);
  void check_features(const PointCloud& points);

  AtomicDirectory directory_;
  PriorManifest manifest_;
  LatticeGrid grid_;
  std::string wkt1_;
  std::int64_t halo_steps_;
  TileSpool tiles_;
  FeatureSpool features_;
  std::vector<std::uint32_t> feature_index_;   ///< of the number that add_feature gave
  std::vector<std::uint16_t> source_index_;    ///< of the position in the sources as they were given
};

}  // namespace priormap
