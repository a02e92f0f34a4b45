#pragma once
#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <optional>

#include <priormap/core/se3.hpp>
#include <priormap/mapping/mapped_scan.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/registration/register_joint.hpp>
#include <priormap/registration/surfel_map.hpp>

namespace priormap {

/// Around where who was lost may be.
struct LostPlace {
  Eigen::Vector3d p_odom = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

/// Where a scan was taken by the scans before it.
struct OdometryStep {
  Eigen::Isometry3d T_odom_sensor = Eigen::Isometry3d::Identity();   ///< at the stamp
  double middle_s = 0;                       ///< of the sweep, from the stamp: the pose there is what matching tells, from where the velocity leads to the stamp
  bool joined = false;                       ///< matched; otherwise lost (for the first scan there is nothing to match)
  bool began_anew = false;                   ///< the old map was given up for one of the scans since: how far that lies off is not known. Such a scan has not joined either
  LostPlace lost;                            ///< where it began anew
  int num_followed = 0;                      ///< where it began anew: lost scans right before this one that are of the new map
  Matrix6d information = Matrix6d::Zero();   ///< of the match, tangent in sensor axes
  Vector6d velocity = Vector6d::Zero();      ///< rad/s, m/s in sensor axes, by which the motion within the sweep was undone
  MatchFigures figures;
};

/// How well the scans of a drive have fitted of late.
class UsualFit {
 public:
  /// Whether a match is as good as may be expected. After a loss more is asked.
  bool admit(const TargetResult& match, bool after_loss) const;
  /// Whether a match is clearly worse than those before, though it may be admitted.
  bool doubts(const MatchFigures& match) const;
  /// Whether a match elsewhere may be the true one, though the local map is worse known there.
  bool may_be(const MatchFigures& match) const;
  void take(const MatchFigures& match);

 private:
  bool has_usual_share(const MatchFigures& match) const;

  double share_ = 0, rmse_m_ = 0, num_known_ = 0;
  int count_ = 0;
};

/// Scan to local map, in a frame of its own, `odom` (REP 105), that begins at the first scan. Knows nothing of the prior: its errors are its own.
class Odometry {
 public:
  /// @param first_velocity  rad/s, m/s in sensor axes, at the first scan
  Odometry(const OdometryOptions& options, const Vector6d& first_velocity);
  /// @param scan  as the moving sensor saw it; on return, if it joined, as it would have been seen from where the sensor was at the stamp
  OdometryStep step(SurfelCloud& scan, double stamp_s);
  /// Takes a step's velocity for a better one, that of its middle.
  static void amend(OdometryStep& step, const Vector6d& velocity);
  void exchange(StateArchive& archive);

 private:
  OdometryStep step_in_middle(SurfelCloud& scan, double middle_s);
  double time_since_last(double middle_s) const;
  PosePrior steady(double duration_s) const;
  OdometryStep matched(const SurfelCloud& scan, const Eigen::Isometry3d& guess, const std::optional<PosePrior>& prior = std::nullopt);
  OdometryStep matched_in_motion(const SurfelCloud& raw, SurfelCloud& scan, double duration_s);
  OdometryStep found_again(const SurfelCloud& scan);
  Eigen::Isometry3d straight_on(double middle_s) const;
  LostPlace lost_place(double middle_s) const;
  void get_lost(const Eigen::Isometry3d& guess, double middle_s);
  OdometryStep followed_apart(SurfelCloud scan, double middle_s);
  bool find_beyond_gap(const SurfelCloud& raw, SurfelCloud& scan, OdometryStep& found, double duration_s);
  std::optional<OdometryStep> found_straight_on(const SurfelCloud& scan);
  std::optional<OdometryStep> found_around(const SurfelCloud& scan, const OdometryStep& found);

  bool gap_is_told(double middle_s) const;

  static constexpr double longest_steady_s = 1;
  OdometryOptions options_;
  JointRegistration registration_;
  SurfelMap local_map_;
  Eigen::Isometry3d T_odom_last_;   // in the middle of the last scan that was matched,
  double stamp_last_s_ = -std::numeric_limits<double>::infinity();
  bool stamp_goes_on_ = true;       // from the scan before to the one that is matched
  double middle_last_s_ = 0;
  Vector6d velocity_;               // and there
  double usual_period_s_ = 0;   // of the scan before
  UsualFit fits_;
  int num_lost_ = 0;
  int num_in_map_ = 0;   // scans
  int num_to_rest_ = 0;   // scans for which searches have run ahead
  int num_to_give_up_ = 0;   // while lost: scans until the old map is given up
  std::unique_ptr<Odometry> apart_;   // while lost: of the scans since then, in the same frame, as if the first of them were where it was guessed
};

}  // namespace priormap
