#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/core/option_field.hpp>
#include <priormap/prior/prior_store.hpp>

namespace priormap {

struct ExportOptions {
  bool sort = false;
  std::vector<double> bbox = {};           ///< west, south, east, north, half-open; empty: everything
  std::string bbox_crs = "EPSG:4326";      ///< without effect on a prior in a local metric frame

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("sort", sort, {"by x, y, z over the whole cloud, whatever the tiles"});
    visit("bbox", bbox, {"W,S,E,N: only the points inside, half-open"});
    visit("bbox-crs", bbox_crs, {"CRS of --bbox"});
  }
};

/// The points of a prior as one cloud, tile by tile or sorted. Its origin is in whole units below the points.
/// @throws FormatError, IoError, UsageError (bbox)
PointCloud prior_cloud(const PriorStore& prior, const ExportOptions& options, const Events& events = {});

/// Writes one cloud by its extension; @return its number of points.
/// @throws also UsageError for an unknown extension, Error when no point is left
std::uint64_t export_cloud(const PriorStore& prior, const std::filesystem::path& file, const ExportOptions& options, Overwrite overwrite,
                           const Events& events = {});

struct AutowareOptions {
  double tile_m = 20;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("autoware-tile", tile_m, {"edge of the tiles of --autoware", "m", 1, 5000});
  }
};

/// Writes DIR/pointcloud_map.pcd/X_Y.pcd, pointcloud_map_metadata.yaml and map_projector_info.yaml: metres of a transverse Mercator
/// projection on WGS 84 at the middle of the points, its scale that of the ground there. @return the number of points.
/// Heights are those of the prior; where these are neither ellipsoidal nor EGM2008 (Autoware knows no others) a warning says so.
/// @throws CrsError for a prior in a local metric frame, or without a known operation to WGS 84
std::uint64_t export_autoware(const PriorStore& prior, const std::filesystem::path& directory, const ExportOptions& options,
                              const AutowareOptions& autoware, Overwrite overwrite, const Events& events = {});

}  // namespace priormap
