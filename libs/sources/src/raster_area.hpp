#pragma once
#include <optional>

#include <priormap/geodesy/transformer.hpp>
#include <priormap/sources/height_raster.hpp>

#include "raster_file.hpp"

namespace priormap {

/// Where a raster lies, for the choice of a coordinate operation; nothing where its bounds have no image in degrees.
std::optional<LonLatArea> area_of(const RasterFacts& facts, const Crs& source);

/// Edge of a cell (geometric mean) in the unit of the target CRS, at the raster's centre.
double target_cell_size(const RasterFile& raster, const Transformer& target_from_source);

}  // namespace priormap
