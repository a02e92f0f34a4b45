#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace priormap {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

/// The matrix of `a x .`.
inline Eigen::Matrix3d hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// Rotation of the rotation vector `w` [rad].
inline Eigen::Quaterniond exp_so3(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const double half_sinc = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  return Eigen::Quaterniond(std::cos(0.5 * angle), half_sinc * w.x(), half_sinc * w.y(), half_sinc * w.z()).normalized();
}

/// Rotation vector [rad] of a unit quaternion, of length at most pi.
inline Eigen::Vector3d log_so3(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  const double scale = sine < 1e-9 ? 2.0 : 2.0 * std::atan2(sine, sign * q.w()) / sine;
  return sign * scale * q.vec();
}

/// Inverse right Jacobian of SO(3): log(exp(w) exp(d)) = w + J d (Sola et al., A micro Lie theory, eq. 144).
inline Eigen::Matrix3d inverse_right_jacobian_so3(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d w_hat = hat(w);
  const double c = angle < 1e-4 ? 1.0 / 12.0 : 1.0 / (angle * angle) - (1.0 + std::cos(angle)) / (2.0 * angle * std::sin(angle));
  return Eigen::Matrix3d::Identity() + 0.5 * w_hat + c * w_hat * w_hat;
}

/// The pose moved by the tangent `xi` = [rotation, translation] in the axes of its own (source) frame:
/// R' = R exp(w), t' = t + R v. In this project every pose tangent, information and covariance is meant so.
inline Eigen::Isometry3d retract(const Eigen::Isometry3d& T, const Vector6d& xi) {
  const Eigen::Quaterniond q = (Eigen::Quaterniond(T.linear()) * exp_so3(xi.head<3>())).normalized();
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.linear() = q.toRotationMatrix();
  moved.translation() = T.translation() + T.linear() * xi.tail<3>();
  return moved;
}

/// Inverse of retract: the tangent that moves `from` to `to`.
inline Vector6d local_coordinates(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  Vector6d xi;
  xi.head<3>() = log_so3(Eigen::Quaterniond(from.linear().transpose() * to.linear()));
  xi.tail<3>() = from.linear().transpose() * (to.translation() - from.translation());
  return xi;
}

/// How a tangent at T_a passes on to T_b = T_a * T_a_b that rides along: its argument is T_b_a, the inverse.
inline Matrix6d adjoint(const Eigen::Isometry3d& T_b_a) {
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = T_b_a.linear();
  A.bottomLeftCorner<3, 3>() = hat(T_b_a.translation()) * T_b_a.linear();
  return A;
}

}  // namespace priormap
