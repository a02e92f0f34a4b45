#include "raster_area.hpp"

#include <cmath>

#include <priormap/geodesy/lon_lat_area.hpp>

namespace priormap {

Transformer target_from_raster(const RasterFacts& facts, const Crs& source, const Crs& target) {
  Transformer transformer(source, target, lon_lat_area(facts.bounds, source));
  transformer.keep_source_longitudes_around(0.5 * (facts.bounds.min_x + facts.bounds.max_x));
  return transformer;
}

double target_cell_size(const RasterFile& raster, const Transformer& target_from_source) {
  const auto corner = [&](double col, double row) {
    const Eigen::Vector2d p = raster.world_from_cell() * Eigen::Vector2d(col, row);
    return Eigen::Vector2d(target_from_source.forward(Eigen::Vector3d(p.x(), p.y(), 0)).head<2>());
  };
  const double col = 0.5 * raster.facts().width, row = 0.5 * raster.facts().height;
  const Eigen::Vector2d along = corner(col + 1, row) - corner(col, row), down = corner(col, row + 1) - corner(col, row);
  return std::sqrt(std::abs(along.x() * down.y() - along.y() * down.x()));
}

}  // namespace priormap
