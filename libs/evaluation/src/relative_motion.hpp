#pragma once
#include <Eigen/Geometry>

#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// (reference motion)^-1 (estimated motion) from pose i to pose j.
inline Eigen::Isometry3d motion_error(const Trajectory& reference, const Trajectory& estimate, std::size_t i, std::size_t j) {
  const Eigen::Isometry3d reference_motion = reference.poses[i].inverse() * reference.poses[j];
  const Eigen::Isometry3d estimated_motion = estimate.poses[i].inverse() * estimate.poses[j];
  return reference_motion.inverse() * estimated_motion;
}

}  // namespace priormap
