#pragma once
#include <functional>
#include <optional>
#include <span>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/geodesy/transformer.hpp>

namespace priormap {

/// Where the edges of a rectangle come to lie in another CRS: a rectangle around its image, and one inside of it (empty where the image
/// is too narrow or too bent to hold one). Both allow for the curvature of the edges between the points tried.
struct ImageBounds {
  Bounds2 outer, inner;
};

/// Nothing where the rectangle leaves the domain of either CRS or goes around the Earth. `bounds` are in `transformer.source()`.
std::optional<ImageBounds> image_bounds(const Bounds2& bounds, const Transformer& transformer);
/// The same for any mapping, which takes points in place and makes them NaN where they have no image.
std::optional<ImageBounds> image_bounds(const Bounds2& bounds, const std::function<void(std::span<Eigen::Vector3d>)>& transform);

}  // namespace priormap
