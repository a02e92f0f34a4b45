#include "pose_residuals.hpp"

namespace priormap {

AbsoluteResidual absolute_residual(const Eigen::Isometry3d& measured, const Eigen::Isometry3d& T) {
  AbsoluteResidual out;
  out.r = local_coordinates(measured, T);
  out.J.setZero();
  out.J.topLeftCorner<3, 3>() = inverse_right_jacobian_so3(out.r.head<3>());
  out.J.bottomRightCorner<3, 3>() = measured.linear().transpose() * T.linear();
  return out;
}

BetweenResidual between_residual(const Eigen::Isometry3d& measured, const Eigen::Isometry3d& T_a, const Eigen::Isometry3d& T_b) {
  const Eigen::Matrix3d R_m_t = measured.linear().transpose();
  const Eigen::Isometry3d T_a_b = T_a.inverse(Eigen::Isometry) * T_b;
  BetweenResidual out;
  out.r = local_coordinates(measured, T_a_b);
  const Eigen::Matrix3d J = inverse_right_jacobian_so3(out.r.head<3>());
  out.J_a.setZero();
  out.J_a.topLeftCorner<3, 3>() = -J * T_a_b.linear().transpose();
  out.J_a.bottomLeftCorner<3, 3>() = R_m_t * hat(T_a_b.translation());
  out.J_a.bottomRightCorner<3, 3>() = -R_m_t;
  out.J_b.setZero();
  out.J_b.topLeftCorner<3, 3>() = J;
  out.J_b.bottomRightCorner<3, 3>() = R_m_t * T_a_b.linear();
  return out;
}

double tukey_weight(double s, double width) {
  if (width == 0) return 1.0;
  const double root = 1.0 - s / (width * width);
  return root > 0 ? root * root : 0.0;
}

double cauchy_weight(double s, double width) { return width == 0 ? 1.0 : 1.0 / (1.0 + s / (width * width)); }

}  // namespace priormap
