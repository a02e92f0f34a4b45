#pragma once
#include <filesystem>
#include <vector>

#include <priormap/core/events.hpp>
#include <priormap/geodesy/map_frame.hpp>
#include <priormap/mapping/mapped_scan.hpp>
#include <priormap/mapping/scan_source.hpp>
#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

struct MapOptions {
  double voxel_m = 0.2;
  double range_m = 100;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("map-voxel", voxel_m, {"edge of the voxels of which the written map keeps the first point each", "m", 0.01, 100});
    visit("map-range", range_m, {"points farther from the sensor stay out of the written map", "m", 1, 1000});
  }
};

/// Writes the mapped points as a prior-like tile set, from the final poses: reads the scans a second time and keeps one point a voxel. Memory is
/// bounded: on long drives far voxels are forgotten, and a street driven again after that may hold a second point in a voxel.
/// @param scans  of `source`, as Mapper::finish returned them   @param frame  that of their poses   @param manifest  gives crs, vertical and sources   @return as written
/// @throws IoError, FormatError naming the file
PriorManifest write_map(const std::filesystem::path& directory, const ScanSource& source, const std::vector<MappedScan>& scans, const MapFrame& frame,
                        PriorManifest manifest, const MapOptions& options, int threads, const Events& events);

}  // namespace priormap
