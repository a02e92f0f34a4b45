#include "turned_frames.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include <priormap/evaluation/alignment.hpp>

namespace priormap {
namespace {

double rmse_m(const Trajectory& reference, const Trajectory& estimate, const Eigen::Isometry3d& T_reference_estimate) {
  double sum = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) sum += (reference.poses[i].translation() - T_reference_estimate * estimate.poses[i].translation()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(reference.size()));
}

/// The shift that lays the middles on each other.
Eigen::Isometry3d shift(const Trajectory& reference, const Trajectory& estimate) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < reference.size(); ++i) sum += reference.poses[i].translation() - estimate.poses[i].translation();
  return Eigen::Isometry3d(Eigen::Translation3d(sum / static_cast<double>(reference.size())));
}

/// Whether what is up in one frame is up in a camera's: against its y.
bool is_up_of_camera(const Eigen::Vector3d& up) { return up.dot(-Eigen::Vector3d::UnitY()) > std::cos(20 * std::numbers::pi / 180); }

std::string cause_and_remedy(const Eigen::Matrix3d& R_reference_estimate) {
  const std::string axes_of_camera = "'s axes are those of a camera (x right, y down, z forward), the ";
  if (is_up_of_camera(R_reference_estimate * Eigen::Vector3d::UnitZ()))
    return "the reference" + axes_of_camera + "estimate's have z up; --kitti-calib CALIB.txt turns the reference into the velodyne's, --align se3 lays the two on each other";
  if (is_up_of_camera(R_reference_estimate.transpose() * Eigen::Vector3d::UnitZ()))
    return "the estimate" + axes_of_camera + "reference's have z up; --align se3 lays the two on each other";
  return "they are not in one frame, or the estimate started elsewhere; --align se3 lays them on each other";
}

}  // namespace

void warn_of_turned_frames(const Trajectory& reference, const Trajectory& estimate, const Events& events) {
  constexpr double least_error_m = 1, least_ratio = 5, least_turn_deg = 30;
  if (reference.size() < 3) return;
  const Eigen::Isometry3d T = find_alignment(reference, estimate, Alignment::se3).T_reference_estimate;
  const double turn_deg = Eigen::AngleAxisd(T.linear()).angle() * 180 / std::numbers::pi;
  // A turn about a straight way is nothing but noise, and so is what it gains on a shift.
  const double shifted_m = rmse_m(reference, estimate, shift(reference, estimate)), aligned_m = rmse_m(reference, estimate, T);
  if (!(turn_deg > least_turn_deg && shifted_m > least_error_m && shifted_m > least_ratio * aligned_m)) return;
  const double as_they_are_m = rmse_m(reference, estimate, Eigen::Isometry3d::Identity());
  char figures[128];
  std::snprintf(figures, sizeof figures, "after a turn by %.0f degrees the positions differ by %.2f m instead of %.2f m (rmse): ", turn_deg, aligned_m, as_they_are_m);
  events.warn(figures + cause_and_remedy(T.linear()));
}

}  // namespace priormap
