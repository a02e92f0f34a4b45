#pragma once
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/tessellation/polygon.hpp>

namespace priormap {

/// Half-open boxes, no two of which meet, that hold all that lies inside the polygons and within `bounds`. Those that an edge passes through are no longer than `longest_m`,
/// the others lie inside: of a sliver across a city the boxes hold little more than the sliver.
std::vector<Bounds2> boxes_over(const std::vector<Polygon2>& polygons, const Bounds2& bounds, double longest_m);

}  // namespace priormap
