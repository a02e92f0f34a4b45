#pragma once
#include <vector>

#include <priormap/tessellation/polygon.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// Vertical quadrilateral over the edge `from` to `to`, outside on the right-hand side of the edge (as along counter-clockwise exteriors).
Face wall_face(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double base_z, double top_z);
/// The outline at height z, facing up, or down for an underside.
Face level_face(const Polygon2& outline, double z, SurfaceClass surface_class, bool facing_up);

/// LoD1 block: walls from `base_z` to `top_z` along every ring, a flat roof at `top_z`, outward normals.
/// Rings as after `normalize`. The underside (outer floor, at `base_z`) on request: then the faces enclose the block.
std::vector<Face> block_faces(const Polygon2& outline, double base_z, double top_z, bool with_underside);

/// The same, triangulated, without the underside: one Surface of class wall, one of class roof (feature and sigma left at their defaults).
std::vector<Surface> extrude(const Polygon2& outline, double base_z, double top_z);

}  // namespace priormap
