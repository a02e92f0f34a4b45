#include "raster_area.hpp"

#include <cmath>

#include <priormap/geodesy/image_bounds.hpp>

namespace priormap {

std::optional<LonLatArea> area_of(const RasterFacts& facts, const Crs& source) {
  const auto image = image_bounds(facts.bounds, Transformer(source.horizontal(), Crs::parse("EPSG:4326")));
  if (!image) return std::nullopt;
  return LonLatArea{image->outer.min_x, image->outer.min_y, image->outer.max_x, image->outer.max_y};
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
