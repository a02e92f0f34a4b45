#pragma once
#include <vector>

#include <priormap/tessellation/polygon.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// LoD1 block: walls from `base_z` to `top_z` along every ring, a flat roof at `top_z`, outward normals.
/// Rings as after `normalize`. One Surface of class wall, one of class roof (feature and sigma left at their defaults).
std::vector<Surface> extrude(const Polygon2& outline, double base_z, double top_z);

}  // namespace priormap
