#pragma once
#include <priormap/registration/surfel_map.hpp>

namespace priormap {

/// The shape of a surfel from its moments alone.
SurfelShape shape_of_moments(const Surfel& surfel, float voxel_m);

/// Whether its points spread across the trace of one laser: by the invariants of their moments, without their axes.
bool is_wide(const Surfel& surfel, float voxel_m);

}  // namespace priormap
