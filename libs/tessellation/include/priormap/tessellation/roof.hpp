#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include <priormap/tessellation/polygon.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// Roof shapes of the OSM wiki's "Simple 3D buildings"; `other` is one that priormap does not build.
enum class RoofShape : std::uint8_t { flat, gabled, hipped, half_hipped, pyramidal, skillion, gambrel, mansard, round, cone, dome, onion, other };

struct RoofSpec {
  RoofShape shape = RoofShape::flat;
  double rise_m = 0;                       ///< from the eaves to the top
  std::optional<double> direction_deg = {};  ///< down the slope, clockwise from the y axis
  bool ridge_across = false;               ///< the ridge runs along the shorter side of the outline
};

/// A roof over an outline: what rain falls on, and where the walls end.
struct Roof {
  std::vector<Polygon3> faces;             ///< planar, facing up; together they cover the outline once
  /// One line for each edge of the outline's rings, in their order: the upper end of the wall over it, from the edge's start to its end.
  std::vector<Ring3> wall_tops;
};

/// Horizontal distance from the eaves to the top, over which a slope climbs; 0 where the shape has no such thing.
double roof_run_m(const Polygon2& outline, const RoofSpec& spec);

/// Builds the roof over a normalized outline, its eaves at `eaves_z`, its top at `eaves_z + rise_m`. Hipped and mansard roofs, and gabled ones over outlines that are no
/// rectangle, stand on the straight skeleton (Aichholzer et al. 1995; CGAL), with gables made by moving the ends of ridges into the end walls. Pyramids, domes
/// and onions need an outline that can be seen whole from its centre.
/// @return nullopt where the shape cannot be built over this outline: take a flat roof.
std::optional<Roof> make_roof(const Polygon2& outline, double eaves_z, const RoofSpec& spec);
Roof flat_roof(const Polygon2& outline, double z);

/// Roof and, `with_walls`, the walls from `base_z` up to it; `with_underside` adds the outer floor at `base_z`, which closes the solid.
/// For a roof without walls the underside is that of the roof (outer ceiling).
std::vector<Face> roofed_faces(const Polygon2& outline, double base_z, const Roof& roof, bool with_walls, bool with_underside);

}  // namespace priormap
