#pragma once
#include <vector>

#include <priormap/tessellation/polygon.hpp>

namespace priormap {

/// Simple polygons of what an odd number of the edges encloses; edges may cross, overlap and repeat.
/// Exteriors counter-clockwise, holes clockwise, ordered by the exterior's smallest vertex; each ring starts at its smallest vertex.
std::vector<Polygon2> even_odd_polygons(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& edges);

}  // namespace priormap
