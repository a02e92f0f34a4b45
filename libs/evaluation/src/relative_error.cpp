#include <priormap/evaluation/relative_error.hpp>

#include "relative_motion.hpp"
#include <priormap/evaluation/absolute_error.hpp>

namespace priormap {
namespace {

/// Poses at which the path since the last such pose reaches `delta_m`.
std::vector<std::size_t> stretch_ends(const Trajectory& trajectory, double delta_m) {
  std::vector<std::size_t> ends;
  double path_m = 0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    path_m += (trajectory.poses[i].translation() - trajectory.poses[i - 1].translation()).norm();
    if (path_m < delta_m) continue;
    ends.push_back(i);
    path_m = 0;
  }
  return ends;
}

}  // namespace

RelativeError relative_error(const Trajectory& reference, const Trajectory& estimate, double delta_m) {
  const std::vector<std::size_t> ends = stretch_ends(estimate, delta_m);
  std::vector<double> translation, rotation;
  for (std::size_t k = 1; k < ends.size(); ++k) {
    const Eigen::Isometry3d error = motion_error(reference, estimate, ends[k - 1], ends[k]);
    translation.push_back(error.translation().norm());
    rotation.push_back(rotation_angle(error.linear()));
  }
  return {statistics(std::move(translation)), statistics(std::move(rotation))};
}

}  // namespace priormap
