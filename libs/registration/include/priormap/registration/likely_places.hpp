#pragma once
#include <Eigen/Geometry>
#include <priormap/registration/surfel.hpp>
#include <priormap/registration/surfel_map.hpp>
#include <span>
#include <vector>

namespace priormap {

/// Where a scan may have been taken whose direction is not known at all and whose place only within many metres: the poses at which most of its walls lie on walls of the maps that face the
/// same way, seen from above. Best first, all distinct; one is right within a metre or two and 0.04 rad, near enough to be registered from.
/// Correlative scan matching (Olson, ICRA 2009) on a grid of a metre and 0.025 rad, by branch and bound over places (Hess et al., ICRA 2016); each direction and 8 x 8 m give their best pose. Walls
/// hold at any height, so streets may climb; where ground is known, the pose lies above it as high as the scan lies above its own.
/// @param scan  with normals   @param ground  its lowest level surfaces are ground; no roofs alone   @param centre  of the search, in the frame of the maps: place, and what is upright   @param radius_m  along x and y, each way   @param most  places returned
/// @return none without walls on both sides
std::vector<Eigen::Isometry3d> likely_places(const SurfelCloud& scan, std::span<const SurfelMap* const> maps, const SurfelMap& ground, const Eigen::Isometry3d& centre, double radius_m, std::size_t most);

}  // namespace priormap
