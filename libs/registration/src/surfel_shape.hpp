#pragma once
#include <priormap/registration/surfel_map.hpp>

namespace priormap {

/// The shape of a surfel from its moments alone.
SurfelShape shape_of_moments(const Surfel& surfel, float voxel_m);

}  // namespace priormap
