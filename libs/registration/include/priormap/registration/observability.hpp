#pragma once
#include <Eigen/Core>
#include <priormap/core/se3.hpp>

namespace priormap {

/// How well an information matrix fixes a pose, direction by direction: standard deviations of the marginal of the translation and of the rotation,
/// largest first, and their axes as unit columns in the same order, in the frame of the tangent (sensor axes). Infinite where nothing is known.
struct Observability {
  Eigen::Vector3d translation_sigma_m;
  Eigen::Matrix3d translation_axes;
  Eigen::Vector3d rotation_sigma_rad;
  Eigen::Matrix3d rotation_axes;
};

/// @param information  symmetric, positive semi-definite; tangent [rotation, translation] of `retract`
Observability observability(const Matrix6d& information);

}  // namespace priormap
