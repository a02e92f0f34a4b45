#pragma once
#include <priormap/core/se3.hpp>

namespace priormap {

/// Residuals of the factors, not whitened, with their exact Jacobians with respect to `retract` of each pose.

struct AbsoluteResidual {
  Vector6d r;
  Matrix6d J;
};

/// local_coordinates(measured, T).
AbsoluteResidual absolute_residual(const Eigen::Isometry3d& measured, const Eigen::Isometry3d& T);

struct BetweenResidual {
  Vector6d r;
  Matrix6d J_a, J_b;
};

/// local_coordinates(measured, T_a^-1 T_b).
BetweenResidual between_residual(const Eigen::Isometry3d& measured, const Eigen::Isometry3d& T_a, const Eigen::Isometry3d& T_b);

/// Weights rho'(s) of the kernels at the whitened square s; 1 where the width is 0.
double tukey_weight(double s, double width);
double cauchy_weight(double s, double width);

}  // namespace priormap
