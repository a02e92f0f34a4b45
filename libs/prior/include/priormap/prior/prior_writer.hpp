#pragma once
#include <filesystem>
#include <memory>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/prior/feature.hpp>
#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

/// Writes a prior directory, whole or not at all, with bounded memory: points are spilled per tile and each tile is sorted
/// (x, y, z, then the other columns), so the bytes depend on the set of points alone: not on order, threads or chunks.
class PriorWriter {
 public:
  /// `manifest` gives crs, vertical, tile size, spacing, sources and generator; counts, bounds and hashes are filled in by `finish`.
  /// @throws IoError when `directory` exists and overwriting is refused.
  PriorWriter(const std::filesystem::path& directory, PriorManifest manifest, Overwrite overwrite);
  ~PriorWriter();

  /// Adds points in the prior's CRS. Positions are rounded to the 1 mm lattice of the CRS; `feature` holds the numbers returned by
  /// `add_feature`. Thread-safe. Points with NaN are an error of the caller.
  void add(const PointCloud& points);
  /// Thread-safe. The returned number is the writer's own; `finish` renumbers features in order of (source, id).
  /// A feature given twice with the same (source, id) is one feature.
  std::uint32_t add_feature(Feature feature);
  /// Facts known only at the end, such as the counts of a source.
  void set_sources(std::vector<PriorSource> sources);
  /// Sorts, writes tiles (in parallel), features, index and manifest; renames into place. @return the manifest as written.
  PriorManifest finish(int threads, const Events& events = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
