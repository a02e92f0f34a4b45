#pragma once
#include <optional>
#include <string>

#include <priormap/core/diagnostics.hpp>
#include <priormap/tessellation/polygon.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// Cleans rings (repeated points, spikes), orients them, and reports defects (val3dity codes) under `feature`.
/// nullopt when nothing usable is left.
std::optional<Polygon2> normalize(const Polygon2& polygon, const std::string& feature, Diagnostics& diagnostics);

/// Constrained Delaunay triangulation of a polygon with holes (CGAL), vertices at z = 0; the triangles' areas sum up to the polygon's.
/// Self-intersecting input is triangulated by the even-odd rule.
TriangleMesh triangulate(const Polygon2& polygon);

/// The same in the polygon's own best-fit plane; `max_deviation_m` gives the distance of the farthest vertex from it.
TriangleMesh triangulate(const Polygon3& polygon, double* max_deviation_m = nullptr);

}  // namespace priormap
