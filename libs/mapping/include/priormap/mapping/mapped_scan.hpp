#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>

#include <priormap/core/se3.hpp>
#include <priormap/mapping/verdict.hpp>

namespace priormap {

/// How a matching went, for the run report.
struct MatchFigures {
  std::size_t num_correspondences = 0;
  std::size_t num_inliers = 0;
  int iterations = 0;
  double inlier_rmse_m = 0;
  bool converged = false;
  bool accepted = false;
};

/// One scan and where it was taken.
struct MappedScan {
  std::size_t index = 0;            ///< in the scan source
  double stamp_s = 0;
  Eigen::Isometry3d T_map_online = Eigen::Isometry3d::Identity();    ///< as known when the scan came
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();    ///< final
  Matrix6d covariance = Matrix6d::Zero();   ///< of T_map_sensor; tangent [rotation, translation] in sensor axes, as in core/se3.hpp
  Vector6d velocity = Vector6d::Zero();     ///< rad/s, m/s in sensor axes
  bool motion_undone = false;               ///< within the sweep, by that velocity and the times of the points
  Verdict verdict = Verdict::lost;
  bool contradicted = false;        ///< the walls of the prior are not where the scans around see walls, or the drive was not found again beyond a gap
  Eigen::Vector3d weak_axis = Eigen::Vector3d::Zero();   ///< unit vector in map axes along which a weak pose is least sure; zero for others
  bool standstill = false;          ///< no pose of its own: repeats the last one
  std::size_t num_points = 0;       ///< as read, without those that are no measurement
  std::size_t num_skipped = 0;      ///< those
  std::optional<MatchFigures> local, prior;
  double step_s = 0;                ///< from reading the file to the online pose
};

}  // namespace priormap
