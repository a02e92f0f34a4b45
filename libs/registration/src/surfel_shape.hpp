#pragma once
#include <priormap/registration/surfel_map.hpp>

namespace priormap {

/// The shape of a surfel from its moments alone.
SurfelShape shape_of_moments(const Surfel& surfel, float voxel_m);

/// The shape of what lies in the 27 voxels around one: single traces of several lasers.
SurfelShape shape_around(const Surfel& all, float voxel_m);

/// Whether its points spread across the trace of one laser: by the invariants of their moments, without their axes.
bool is_wide(const Surfel& surfel, float voxel_m);

/// Whether the points of a surfel of a scan lie in one plane through the sensor's z axis: a column of the scanning, such as stands alone on a wall seen so slantwise that the next one misses the voxel. It
/// looks like a pole, but travels with the sensor. A pole within some 20 m is wider.
bool is_one_column(const Surfel& surfel);

/// Planes whose normals are within 26 degrees of that of the cone may be what the way of scanning draws.
inline constexpr float near_cone_cosine = 0.9f;

/// Of the cone that a laser draws that spins about the sensor's z axis, where it meets `p`, from the sensor; zero on the axis.
Eigen::Vector3f cone_normal(const Eigen::Vector3f& p);

}  // namespace priormap
