#pragma once
#include <priormap/tessellation/polygon.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// Constrained Delaunay triangulation of a polygon with holes (CGAL), vertices at z = 0, counter-clockwise; the triangles' areas sum up to the polygon's.
/// Self-intersecting input is triangulated by the even-odd rule.
TriangleMesh triangulate(const Polygon2& polygon);

/// The same in the polygon's own best-fit plane, keeping its vertices; `max_deviation_m` gives the distance of the farthest vertex from that plane.
/// Empty when the polygon has no area.
TriangleMesh triangulate(const Polygon3& polygon, double* max_deviation_m = nullptr);

}  // namespace priormap
