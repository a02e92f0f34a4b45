#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace priormap {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Outcome of one registration. Tangent order [rotation, translation], left perturbation in the target frame:
/// T_target_source = exp(xi) * T.
struct RegistrationResult {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  bool converged = false;
  int iterations = 0;
  std::size_t num_correspondences = 0;
  std::size_t num_inliers = 0;
  double inlier_rmse_m = 0;
  Matrix6d information = Matrix6d::Zero();   ///< J^T W J at the solution
  double inlier_share() const { return num_correspondences == 0 ? 0.0 : double(num_inliers) / double(num_correspondences); }
};

}  // namespace priormap
