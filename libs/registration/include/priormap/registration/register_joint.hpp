#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <priormap/registration/instruction_set.hpp>
#include <priormap/registration/registration_result.hpp>
#include <priormap/registration/surfel.hpp>
#include <priormap/registration/surfel_map.hpp>
#include <span>
#include <vector>

namespace priormap {

/// A map to register against, and how far its word counts.
struct JointTarget {
  const SurfelMap* map = nullptr;   ///< not null; as it is until what was registered against it has been asked for (`plane_matches`)
  double sigma_m = 0.02;   ///< added (in squares) to the sigma of each of its surfels
  double weight = 1.0;     ///< on its whole information: below 1 where the errors of neighbouring surfels hang together
  Eigen::Isometry3d T_target_map = Eigen::Isometry3d::Identity();   ///< for a map kept in a frame of its own, such as that of the odometry
};

/// What each is stands in its description below; all numbers are above 0.
struct JointOptions {
  double max_distance_m = 2.0;
  double kernel_width = 3.0;
  double point_sigma_m = 0.03;
  double start_scale = 4.0;
  double min_scale = 0.15;
  int max_iterations = 30;
  double translation_epsilon_m = 5e-4;
  double rotation_epsilon_rad = 2e-5;
  /// Of scans of few lasers: the kernel is wider for what tells of the direction of which they tell least, so that the few that do are no outliers among the many that do not (docs/adr/0022).
  /// Right against the scans before; a prior's own errors along that direction would be heard as well.
  bool hears_weakest_direction = true;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("joint-max-distance", max_distance_m, {"correspondences farther apart are dropped", "m", 0.01, 100});
    visit("joint-kernel-width", kernel_width, {"width of the Geman-McClure kernel, in robust standard deviations of the residuals", "", 0.5, 100});
    visit("point-sigma", point_sigma_m, {"standard deviation of a scan's points along the normal", "m", 1e-3, 10});
    visit("start-scale", start_scale, {"least scale at the first step, halved with each step down to min-scale", "", 0.01, 1000});
    visit("min-scale", min_scale, {"least robust standard deviation of the whitened residuals", "", 0.01, 100});
    visit("joint-iterations", max_iterations, {"most Gauss-Newton steps of one registration", "", 1, 1000});
    visit("joint-translation-epsilon", translation_epsilon_m, {"a step shorter than this and turning less than joint-rotation-epsilon ends it", "m", 1e-9, 1});
    visit("joint-rotation-epsilon", rotation_epsilon_rad, {"see joint-translation-epsilon", "rad", 1e-9, 1});
  }
};

/// Where to look for a pose that is badly known: a grid of starts around the guess, over x and y of the map and the yaw about its z axis.
struct PoseSearchOptions {
  double radius_m = 6.0;     ///< along x and y, each way; 0: the guess alone
  double yaw_rad = 0.21;     ///< each way
  double step_m = 1.0;       ///< above 0, as step_rad
  double step_rad = 0.035;
  double sigma_m = 0.3;      ///< of the residuals while starts are compared
  int surfels = 400;         ///< of the scan, for comparing starts; 1 at least, as refined
  int refined = 8;           ///< best starts that are registered
};

/// What is known of the pose beforehand; `information` with the tangent of `retract` at T.
struct PosePrior {
  Eigen::Isometry3d T_map_scan = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();
};

/// The part of one target in a joint registration, at the pose returned.
struct TargetResult {
  std::size_t num_correspondences = 0;
  std::size_t num_inliers = 0;               ///< whitened residual below kernel_width: what the stated sigmas explain
  double inlier_rmse_m = 0;
  Matrix6d information = Matrix6d::Zero();   ///< J^T W J of this target alone, times its weight, and divided by the square of the residuals' robust standard deviation where they scatter more than stated; for few lasers less is known along the direction that it tells least of
  double inlier_share() const { return num_correspondences == 0 ? 0.0 : double(num_inliers) / double(num_correspondences); }
};

/// A surfel of the scan and the plane of a map that it was compared with.
struct PlaneMatch {
  Eigen::Vector3d p_map;      ///< the surfel's mean, in the frame of the target
  Eigen::Vector3d normal;     ///< of the plane
  double residual_m = 0;      ///< of p_map from the plane
  double scan_variance_m2 = 0;   ///< of the residual, by the scan: its point noise, and its own spread along the normal
  std::uint32_t feature = PointCloud::no_feature;   ///< of the plane
  Eigen::Vector3d plane_mean = Eigen::Vector3d::Zero();        ///< of the points by which the plane is known
  Eigen::Matrix3d scan_covariance = Eigen::Matrix3d::Zero();   ///< of the surfel's points [m^2], in the axes of the target
};

struct JointResult {
  Eigen::Isometry3d T_map_scan = Eigen::Isometry3d::Identity();
  bool converged = false;
  int iterations = 0;
  Matrix6d information = Matrix6d::Zero();   ///< of all targets and the pose prior together, by which the last step was made
  std::vector<TargetResult> targets;         ///< in the order given
};

struct ScoredResult {
  JointResult match;
  double score = 0;   ///< as of `score`; against another pose, what speaks for this one, in surfels
};

/// Registers scans against several maps at once: the normal equations of all targets add up to one 6x6 system (and a prior on the pose, if given), solved by Gauss-Newton.
/// A residual is the distance of a scan surfel's mean from the plane (line, point) of the nearest map surfel, whitened by the sum of that surfel's variance, the point
/// noise, and the scan surfel's own covariance along the normal (plane to plane: Segal et al., Generalized-ICP, RSS 2009, where both normals agree; a scan surfel that does
/// not lie in the plane weighs little). Geman-McClure kernel; its width follows, target by target and iteration by iteration, the median of the residuals; for few lasers it is wider for what tells of the direction that they tell least of (`hears_weakest_direction`).
/// Scans with normals: ground is not compared with walls.
/// A correspondence is searched anew only when the mean has moved by half the gap between the nearest and the second-nearest surfel.
/// One thread; keeps its buffers from scan to scan. Same bytes for the same input.
class JointRegistration {
 public:
  /// @throws UsageError for an instruction set that the processor lacks, or unless point_sigma_m, kernel_width and min_scale are above 0
  explicit JointRegistration(const JointOptions& options = {}, InstructionSet set = InstructionSet::best);
  ~JointRegistration();
  JointRegistration(JointRegistration&&) noexcept;
  JointRegistration& operator=(JointRegistration&&) noexcept;

  /// The pose of `scan` in the frame of the targets, from `guess`, which may be off by about max_distance_m and some degrees.
  /// Not converged: too little was found to solve for a pose (the guess comes back), or max_iterations.
  /// @throws Error for a scan with normals for some of its surfels alone
  JointResult align(const SurfelCloud& scan, std::span<const JointTarget> targets, const Eigen::Isometry3d& guess,
                    const std::optional<PosePrior>& prior = std::nullopt);

  /// Registrations from a grid of starts, best first (correlative scan matching: Olson, ICRA 2009): starts are ranked by how many surfels find a map surfel that fits, the
  /// best are registered with `align`, those that end in the same place count once. For the first pose and for finding back; thousands of starts take tenths of a second.
  /// @param against  poses are ranked by what speaks for them rather than for this one, of the scan in the map: how surfels fit counts by how much the two poses move them along the normals of
  ///                 the planes that they lie near. Most of a street, and all rings of a lidar on level ground, fit anywhere along it
  std::vector<ScoredResult> search(const SurfelCloud& scan, std::span<const JointTarget> targets, const Eigen::Isometry3d& guess, const PoseSearchOptions& options = {},
                                   const std::optional<Eigen::Isometry3d>& against = std::nullopt);

  /// How well a scan fits at a pose: 0.15 for each surfel that does, down to -0.85 for one whose nearest plane is far off; none for one that the maps do not know.
  /// @param sigma_m  added (in squares) to those of the targets: how far off still fits
  double score(const SurfelCloud& scan, std::span<const JointTarget> targets, const Eigen::Isometry3d& T_map_scan, double sigma_m);
  /// By how much a scan fits walls better at each of some poses nearby: up to 1 for each surfel that has a match at both (some hundred of them stand for all).
  /// @param elsewhere  of the scan in the map, within some metres of `T_map_scan`   @param sigma_m  as of `score`   @return one for each of `elsewhere`
  std::vector<double> improvements(const SurfelCloud& scan, std::span<const JointTarget> targets, const Eigen::Isometry3d& T_map_scan, std::span<const Eigen::Isometry3d> elsewhere, double sigma_m);

  /// Which planes of target `t` the last `align` compared with, at the pose it returned but for its last step.
  std::vector<PlaneMatch> plane_matches(std::size_t t) const;

 private:
  struct Workspace;
  double score(const Eigen::Isometry3d& T_map_scan);
  void remember(const Eigen::Isometry3d& T_map_scan);
  double gain(const Eigen::Isometry3d& T_map_scan);
  JointOptions options_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace priormap
