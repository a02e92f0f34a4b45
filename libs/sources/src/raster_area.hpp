#pragma once
#include <priormap/geodesy/transformer.hpp>
#include <priormap/sources/height_raster.hpp>

#include "raster_file.hpp"

namespace priormap {

/// By the operation for where the raster lies; longitudes of the raster are counted as it counts them: across the antimeridian, or from 0 to 360.
Transformer target_from_raster(const RasterFacts& facts, const Crs& source, const Crs& target);

/// Edge of a cell (geometric mean) in the unit of the target CRS, at the raster's centre.
double target_cell_size(const RasterFile& raster, const Transformer& target_from_source);

}  // namespace priormap
