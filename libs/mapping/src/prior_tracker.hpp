#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include <priormap/mapping/mapped_scan.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/prior_window.hpp>
#include <priormap/registration/register_joint.hpp>

#include "odometry.hpp"
#include "prior_surfels.hpp"

namespace priormap {

/// What the prior says of a scan.
struct PriorMatch {
  MatchFigures figures;
  double share = 0;   ///< of the scan's surfels that the prior knows
};

/// How `odom` lies in `map`, followed along the drive: each few metres a scan is matched to the prior and to where the odometry says it was, in one system
/// (a Kalman filter whose measurement update is the registration). Errors of the prior hang together from scan to scan: a match, however many points it has, counts
/// as no surer than `prior_floor_m`.
class PriorTracker {
 public:
  /// @param scan_voxel_m  to which the scans are reduced
  PriorTracker(const TrackingOptions& options, double scan_voxel_m, const std::optional<NearTiles>& prior, const Eigen::Isometry3d& T_map_first);
  /// To each scan that the odometry joined.
  void go_on(const Eigen::Isometry3d& T_odom_sensor);
  /// Whether the prior is to be asked there.
  bool asks() const;
  /// Where it `asks`. @return what the prior says; none to a scan without surfels
  std::optional<PriorMatch> follow(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor);
  /// The odometry has a gap: the next scans are looked for, in any direction and turned anyhow, until they fit clearly. @param lost  around there, and as far again as the way since
  void begin_anew(const LostPlace& lost);
  /// Whether the drive has been found, since the odometry began anew. At first it is where the user says,
  bool is_found() const { return located_; }
  /// unless the scans contradict; they may be the first ones alone.
  bool is_located() const { return located_ && !start_in_doubt_; }
  /// Whether the drive has been found far from where the user says that it starts: poses before this one are to be known from here.
  bool started_elsewhere() const { return started_elsewhere_; }
  Eigen::Isometry3d T_map_odom() const { return T_map_odom_; }
  void exchange(StateArchive& archive);

 private:
  /// Where the drive may be, and how well the scans heard since then fit there.
  struct Hypothesis {
    Eigen::Isometry3d T_map_odom;
    double sum = 0, num_surfels = 0;
    int num_heard = 0;   // scans
    double score() const { return sum / num_surfels; }   // a surfel
  };
  using Hypotheses = std::vector<Hypothesis>;
  static const Hypothesis& best_of(const Hypotheses& hypotheses);
  /// Of those that are another place than that.
  static double best_score_elsewhere(const Hypotheses& hypotheses, const Eigen::Isometry3d& T_map_sensor, const Eigen::Isometry3d& T_odom_sensor);
  static void propose(Hypotheses& hypotheses, const Eigen::Isometry3d& T_map_sensor, const Eigen::Isometry3d& T_odom_sensor);
  bool compares() const;
  void look_anew();
  void propose_places(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map);
  void compare_hypotheses(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map);
  void hear(Hypotheses& hypotheses, const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map);
  Eigen::Vector3d centre_of_search() const { return T_map_odom_lost_ * lost_.p_odom; }
  std::vector<Eigen::Isometry3d> places_all_around(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map);
  void look_farther(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map);
  void drop_farther_places(double score_near_start);
  bool takes_farther_place(double score_near_start, const Eigen::Isometry3d& T_odom_sensor);

  PriorMatch word_of(const JointResult& match, std::size_t num_surfels) const;
  Matrix6d predicted_covariance(const Eigen::Isometry3d& T_odom_sensor) const;

  TrackingOptions options_;
  double scan_voxel_m_;
  std::optional<PriorWindow<PriorSurfels>> prior_;
  JointRegistration registration_;
  Eigen::Isometry3d T_map_odom_;
  std::optional<Eigen::Isometry3d> T_odom_last_;   // where the prior was asked last
  Eigen::Vector3d p_odom_ = Eigen::Vector3d::Zero();
  double way_since_asked_m_ = 0;                   // from scan to scan: who manoeuvres in place drifts as well
  bool heard_last_ = false;                        // whether it held the scan then
  Matrix6d covariance_ = Matrix6d::Zero();         // of T_map_odom * T_odom_last, tangent in sensor axes
  PriorSurfels::Weights prior_weights_ = PriorSurfels::unweighted;
  Hypotheses hypotheses_;                          // where the drive may have begun; the first is the one given
  Hypotheses farther_;                             // where else, should that be wrong by far
  // Where to look all around: at the start, or where the odometry lost the drive.
  Eigen::Isometry3d T_map_odom_lost_;              // as it was there
  LostPlace lost_{.radius_m = 50};
  double lost_step_m_ = 0;                         // way between scans that are matched to the prior while it is not located
  bool lost_once_ = false;
  bool located_ = true;
  bool started_elsewhere_ = false;
  bool start_in_doubt_ = false;
  double usual_score_ = 0.1;   // a surfel, where the drive was
  int num_heard_ = 0;
};

}  // namespace priormap
