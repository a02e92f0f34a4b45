#pragma once
#include <priormap/evaluation/statistics.hpp>
#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// RPE over consecutive pairs `delta_m` apart: translation length and angle of (reference motion)^-1 (estimated motion).
///
/// Pairs are chained as evo chains them, along the *estimate's* path: a pose ends a stretch when the path since the last end reaches
/// `delta_m`; pairs join consecutive ends, so that the first pose is in none.
struct RelativeError {
  Statistics translation_m;
  Statistics rotation_rad;
};

/// Trajectories of equal length.
RelativeError relative_error(const Trajectory& reference, const Trajectory& estimate, double delta_m);

}  // namespace priormap
