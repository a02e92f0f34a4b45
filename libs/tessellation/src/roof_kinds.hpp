#pragma once
#include <optional>

#include <priormap/tessellation/roof.hpp>

namespace priormap {

/// Rectangle around an outline with the smallest area, one side along one of the outline's edges.
struct OrientedBox {
  Eigen::Vector2d center, along, across;  ///< unit vectors, along the longer side
  double half_length = 0, half_width = 0;
};
OrientedBox oriented_box(const Ring2& ring);

/// Roofs that are the lowest of a few planes at every spot: skillion, gabled, half-hipped, gambrel, round.
std::optional<Roof> envelope_roof(const Polygon2& outline, double eaves_z, const RoofSpec& spec);
/// Roofs that rise from the whole outline towards its centre: pyramidal, cone, dome, onion.
std::optional<Roof> radial_roof(const Polygon2& outline, double eaves_z, const RoofSpec& spec);
/// Roofs on the straight skeleton: hipped, mansard, gabled.
std::optional<Roof> skeleton_roof(const Polygon2& outline, double eaves_z, const RoofSpec& spec);

double envelope_run_m(const Polygon2& outline, const RoofSpec& spec);
double radial_run_m(const Polygon2& outline);
/// The largest distance from the edges that a point inside has, as the skeleton measures it; 0 where there is no skeleton.
double skeleton_run_m(const Polygon2& outline);

/// Wall tops at one level along all rings.
std::vector<Ring3> level_wall_tops(const Polygon2& outline, double z);

}  // namespace priormap
