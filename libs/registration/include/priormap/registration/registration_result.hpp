#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <priormap/core/se3.hpp>

namespace priormap {

/// Outcome of one registration. The tangent of `information` is that of `retract` (core/se3.hpp): [rotation, translation] in the
/// axes of the source (sensor) frame, so that the same matrix serves an absolute factor on T_map_sensor and a between factor on
/// T_previous_sensor, and its numbers stay small however far the map's origin is.
struct RegistrationResult {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  bool converged = false;
  int iterations = 0;
  std::size_t num_correspondences = 0;      ///< source points with a target point within the correspondence distance
  std::size_t num_inliers = 0;              ///< correspondences whose residual is below the kernel width
  double inlier_rmse_m = 0;
  Matrix6d information = Matrix6d::Zero();  ///< J^T W J at the solution, residuals in metres of unit variance, W the kernel's weights
  double inlier_share() const { return num_correspondences == 0 ? 0.0 : double(num_inliers) / double(num_correspondences); }
};

}  // namespace priormap
