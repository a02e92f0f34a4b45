#include <priormap/evaluation/common_frame.hpp>

#include <cmath>
#include <optional>

#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/map_frame.hpp>
#include <priormap/geodesy/transformer.hpp>

namespace priormap {
namespace {

/// Positions through PROJ; orientations turn by the angle between the two grids' north at the position.
void transform_poses(Trajectory& trajectory, const Crs& target) {
  const Transformer transformer(Crs::parse(trajectory.crs), target);
  constexpr double northward_units = 10;
  for (Eigen::Isometry3d& pose : trajectory.poses) {
    const Eigen::Vector3d here = pose.translation();
    const Eigen::Vector3d to = transformer.forward(here);
    const Eigen::Vector3d north = transformer.forward(Eigen::Vector3d(here + northward_units * Eigen::Vector3d::UnitY())) - to;
    const Eigen::AngleAxisd turn(std::atan2(-north.x(), north.y()), Eigen::Vector3d::UnitZ());
    pose.linear() = turn * pose.linear();
    pose.translation() = to;
  }
  trajectory.crs = target.name();
}

void to_map(Trajectory& trajectory, const MapFrame& frame) {
  for (Eigen::Isometry3d& pose : trajectory.poses) pose = frame.pose_to_map(pose);
  trajectory.crs.clear();
}

void to_own_map(Trajectory& trajectory) {
  if (trajectory.crs.empty()) return;
  to_map(trajectory, MapFrame::at(Crs::parse(trajectory.crs), trajectory.poses.front().translation()));
}

}  // namespace

void to_common_frame(Trajectory& reference, Trajectory& estimate) {
  if (reference.crs.empty() || estimate.crs.empty()) {
    to_own_map(reference);
    to_own_map(estimate);
    return;
  }
  const Crs crs = Crs::parse(reference.crs);
  if (!crs.equivalent_to(Crs::parse(estimate.crs))) transform_poses(estimate, crs);
  const MapFrame frame = MapFrame::at(crs, reference.poses.front().translation());
  to_map(reference, frame);
  to_map(estimate, frame);
}

}  // namespace priormap
