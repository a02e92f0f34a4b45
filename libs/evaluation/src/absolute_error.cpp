#include <priormap/evaluation/absolute_error.hpp>

#include <cmath>

namespace priormap {

double rotation_angle(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

std::vector<double> path_lengths(const Trajectory& trajectory) {
  std::vector<double> lengths(trajectory.size(), 0.0);
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    lengths[i] = lengths[i - 1] + (trajectory.poses[i].translation() - trajectory.poses[i - 1].translation()).norm();
  return lengths;
}

AbsoluteError absolute_error(const Trajectory& reference, const Trajectory& estimate) {
  std::vector<double> position, horizontal, vertical, rotation;
  double vertical_sum = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Eigen::Vector3d difference = estimate.poses[i].translation() - reference.poses[i].translation();
    position.push_back(difference.norm());
    horizontal.push_back(difference.head<2>().norm());
    vertical.push_back(difference.z());
    vertical_sum += difference.z();
    rotation.push_back(rotation_angle(reference.poses[i].linear().transpose() * estimate.poses[i].linear()));
  }
  AbsoluteError error;
  error.position_m = statistics(std::move(position));
  error.horizontal_m = statistics(std::move(horizontal));
  error.vertical_m = statistics(std::move(vertical));
  error.rotation_rad = statistics(std::move(rotation));
  if (reference.size() > 0) error.vertical_bias_m = vertical_sum / static_cast<double>(reference.size());
  return error;
}

}  // namespace priormap
