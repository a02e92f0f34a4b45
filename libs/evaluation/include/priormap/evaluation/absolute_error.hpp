#pragma once
#include <priormap/evaluation/statistics.hpp>
#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// ATE: distances of paired positions, as they are (Sturm et al., IROS 2012; the alignment comes before).
struct AbsoluteError {
  Statistics position_m;
  Statistics horizontal_m;        ///< in the x-y plane
  Statistics vertical_m;          ///< along z
  double vertical_bias_m = 0;     ///< mean of estimate less reference along z
  Statistics rotation_rad;        ///< angle of R_reference^T R_estimate
};

/// Trajectories of equal length.
AbsoluteError absolute_error(const Trajectory& reference, const Trajectory& estimate);

/// Angle of a rotation in [0, pi], exact also for tiny angles.
double rotation_angle(const Eigen::Matrix3d& R);

/// Length of the way to each pose [m], summed over the positions; the first is 0.
std::vector<double> path_lengths(const Trajectory& trajectory);

}  // namespace priormap
