#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/pointcloud/las.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/prior/feature.hpp>
#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

/// Writes a prior directory, whole or not at all, with bounded memory: points are collected per tile, beyond `memory_bytes` on disk.
/// Each tile is sorted (x, y, z, then the other columns), so the bytes depend on the set of points alone: not on order, threads or
/// chunks. Two points of one source and one feature at one place are one point.
///
/// Positions are rounded to the lattice of 0.001 CRS units. A cloud holds float32 relative to its origin: where the same point
/// may come in different chunks, let origins depend on the feature or the source alone, or the rounding may differ by a millimetre.
class PriorWriter {
 public:
  static constexpr std::size_t default_memory_bytes = std::size_t(256) << 20;

  /// `manifest` gives crs, tile size [CRS units, 1 to 5000, whole millimetres], spacing, sources and generator; everything else is
  /// filled in. Sources are put in order of (precedence, id).
  /// @throws IoError when `directory` exists and overwriting is refused, CrsError when the CRS is not projected, UsageError for the
  /// tile size.
  PriorWriter(const std::filesystem::path& directory, PriorManifest manifest, Overwrite overwrite,
              std::size_t memory_bytes = default_memory_bytes);
  ~PriorWriter();

  /// Adds points in the prior's CRS. `feature` holds the numbers returned by `add_feature`, `source` positions in the sources as they
  /// were given. Thread-safe. @throws Error for a position that is no number, or an unknown source or feature.
  void add(const PointCloud& points);
  /// Points on the lattice already, which need no rounding and no columns: x and y count from `corner`, z is the height [0.001 CRS units]. Takes their x and y.
  /// Thread-safe. @throws Error for an unknown source or feature.
  void add(LatticePoint corner, std::span<LasPoint> points);
  /// Thread-safe. The returned number is the writer's own; `finish` renumbers features in order of (source, id) and leaves out
  /// those without a point. A feature given twice with the same (source, id) is one feature.
  std::uint32_t add_feature(const Feature& feature);
  /// Writes a tile at once, whose points have all been added: keeps memory small and spares the way over the disk. Thread-safe.
  /// @throws Error when it holds points of features, whose numbers are known at the end only, or more of its points come later; IoError.
  void close_tile(TileKey key);
  /// Facts known only at the end, such as the counts of a source; the same sources in the same order.
  void set_sources(std::vector<PriorSource> sources);
  /// Writes tiles (in parallel), features, index, manifest and ATTRIBUTION.txt; renames into place. @return the manifest as written.
  /// @throws IoError, on a full disk as well.
  PriorManifest finish(int threads, const Events& events = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
