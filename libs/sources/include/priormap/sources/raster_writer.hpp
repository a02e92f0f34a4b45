#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <vector>

#include <priormap/geodesy/crs.hpp>

namespace priormap {

/// North-up raster of heights: row 0 is the northernmost, values row by row, NaN where unknown. A cell's value belongs to its centre.
struct HeightGrid {
  double west = 0, north = 0;     ///< outer corner of the first cell [CRS units]
  double cell_size = 1;           ///< [CRS units]
  std::size_t columns = 0, rows = 0;
  std::vector<float> heights_m;   ///< columns * rows

  Eigen::Vector2d cell_centre(std::size_t column, std::size_t row) const {
    return {west + (static_cast<double>(column) + 0.5) * cell_size, north - (static_cast<double>(row) + 0.5) * cell_size};
  }
};

/// Writes a GeoTIFF (float32, deflate, nodata -9999 in place of NaN) with the CRS, heights included where it has any.
/// Plain write: callers put it inside an AtomicFile or AtomicDirectory. Same raster, same bytes.
/// @throws IoError when it cannot be written whole.
void write_geotiff(const std::filesystem::path& file, const HeightGrid& raster, const Crs& crs);

}  // namespace priormap
