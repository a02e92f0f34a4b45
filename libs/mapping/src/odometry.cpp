#include "odometry.hpp"

#include <array>
#include <utility>

#include <priormap/mapping/motion.hpp>

namespace priormap {

Odometry::Odometry(const OdometryOptions& options, const Eigen::Isometry3d& first_motion)
    : options_(options), registration_(options.registration), local_map_(options.local_map), T_odom_before_last_(first_motion.inverse()),
      T_odom_last_(Eigen::Isometry3d::Identity()) {}

OdometryStep Odometry::step(const SurfelCloud& scan) {
  OdometryStep found;
  const bool first = local_map_.empty();
  if (!first) {
    found.T_odom_sensor = predict(T_odom_before_last_, T_odom_last_);
    const std::array targets = {JointTarget{&local_map_, options_.local_sigma_m, 1.0}};
    const JointResult match = registration_.align(scan, targets, found.T_odom_sensor);
    const TargetResult& local = match.targets.front();
    found.joined = local.num_correspondences > 0 && local.inlier_share() > options_.min_inlier_share;
    found.figures = {local.num_correspondences, local.num_inliers, match.iterations, local.inlier_rmse_m, match.converged, found.joined};
    if (found.joined) {
      found.T_odom_sensor = match.T_map_scan;
      found.information = local.information;
    }
    T_odom_before_last_ = T_odom_last_;
    T_odom_last_ = found.T_odom_sensor;
  }
  local_map_.insert(scan, found.T_odom_sensor);
  local_map_.remove_beyond(found.T_odom_sensor.translation(), options_.local_map_radius_m);
  return found;
}

}  // namespace priormap
