#pragma once
#include <Eigen/Geometry>

namespace priormap {

/// The pose after `last` if the motion from `before_last` goes on unchanged (the paper, section III-E): t + (t - t'), q' (q'^-1 q)^2, which is
/// slerp(q', q, 2). Needs no stamps.
Eigen::Isometry3d predict(const Eigen::Isometry3d& T_map_before_last, const Eigen::Isometry3d& T_map_last);

}  // namespace priormap
