#pragma once
#include <Eigen/Geometry>

#include <priormap/core/se3.hpp>
#include <priormap/mapping/mapped_scan.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/registration/register_joint.hpp>
#include <priormap/registration/surfel_map.hpp>

namespace priormap {

/// Where a scan was taken by the scans before it.
struct OdometryStep {
  Eigen::Isometry3d T_odom_sensor = Eigen::Isometry3d::Identity();
  bool joined = false;                       ///< matched; otherwise the motion was only carried on (and for the first scan there is nothing to match)
  Matrix6d information = Matrix6d::Zero();   ///< of the match, tangent in sensor axes
  MatchFigures figures;
};

/// Scan to local map, in a frame of its own, `odom` (REP 105), that begins at the first scan. Knows nothing of the prior: its errors are its own.
class Odometry {
 public:
  /// @param first_motion  T_previous_sensor at the first scan
  Odometry(const OdometryOptions& options, const Eigen::Isometry3d& first_motion);
  OdometryStep step(const SurfelCloud& scan);

 private:
  OdometryOptions options_;
  JointRegistration registration_;
  SurfelMap local_map_;
  Eigen::Isometry3d T_odom_before_last_, T_odom_last_;
};

}  // namespace priormap
