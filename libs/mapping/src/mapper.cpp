#include <priormap/mapping/mapper.hpp>

#include <numbers>

#include <priormap/mapping/motion.hpp>
#include <priormap/pointcloud/downsample.hpp>

namespace priormap {
namespace {

/// Fewer of a scan's points with a neighbour in the prior than this share, and there is no prior to speak of.
constexpr double outside_share = 0.05;
/// Below this share the prior holds the pose by a corner of the scan only.
constexpr double weak_share = 0.3;

PointCloud thin(const PointCloud& points, double voxel_m) {
  PointCloud positions;
  positions.origin = points.origin;
  positions.xyz = points.xyz;
  return voxel_downsample_centroid(positions, voxel_m);
}

MatchFigures figures_of(const RegistrationResult& r, bool accepted) {
  return {r.num_correspondences, r.num_inliers, r.iterations, r.inlier_rmse_m, r.converged, accepted};
}

/// Information a point of the scan: the kernel widths of the pose graph then read as metres, whatever the number of points, and a map that
/// only a corner of the scan has met weighs little.
Matrix6d information_a_point(const RegistrationResult& r, std::size_t num_points) { return r.information / static_cast<double>(num_points); }

/// For a motion that is only the last one carried on: half a metre and two degrees.
Matrix6d carried_information() {
  Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(0.035), Eigen::Vector3d::Constant(0.5);
  return sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
}

}  // namespace

Mapper::Mapper(const MapperOptions& options, PriorMap* prior, const Eigen::Isometry3d& T_map_first, int threads)
    : options_(options), prior_(prior), threads_(threads), T_map_last_(T_map_first), T_map_before_last_(T_map_first), local_map_(options.voxels),
      graph_(options.graph) {}

const MappedScan& Mapper::step(const Scan& scan) {
  const PointCloud points = thin(scan.points, options_.downsample_m);
  const bool first = scans_.empty();
  const Eigen::Isometry3d guess = predict(T_map_before_last_, T_map_last_);

  MappedScan mapped;
  mapped.index = scan.index;
  mapped.stamp_s = scan.stamp_s;
  mapped.num_points = scan.points.size();
  mapped.num_skipped = scan.num_skipped;

  std::optional<RegistrationResult> to_local;
  if (!first) to_local = register_scan(points, local_map_, guess, options_.icp, threads_);
  if (to_local && stands_still(*to_local)) {
    repeat_last(mapped);
  } else {
    std::optional<RegistrationResult> to_prior;
    if (prior_) to_prior = register_scan(points, prior_->around(guess.translation()), guess, options_.icp, threads_);
    place(mapped, guess, to_local, to_prior, points.size());
    local_map_.insert(scan.points, mapped.T_map_online);
    local_map_.remove_beyond(mapped.T_map_online.translation(), options_.local_map_radius_m);
    T_map_before_last_ = first ? mapped.T_map_online : T_map_last_;
    T_map_last_ = mapped.T_map_online;
  }
  scans_.push_back(mapped);
  return scans_.back();
}

/// Motion counts from the last pose that was added: creeping along adds up until it is seen. A vehicle that turns on the spot does not stand still.
bool Mapper::stands_still(const RegistrationResult& to_local) const {
  const Eigen::Isometry3d motion = T_map_last_.inverse() * to_local.T_target_source;
  return to_local.converged && motion.translation().norm() < options_.min_motion_m &&
         Eigen::AngleAxisd(motion.linear()).angle() < options_.min_turn_deg * std::numbers::pi / 180;
}

void Mapper::repeat_last(MappedScan& mapped) {
  mapped.T_map_online = T_map_last_;
  mapped.verdict = scans_.back().verdict;
  mapped.standstill = true;
  pose_of_scan_.push_back(pose_of_scan_.back());
  T_map_before_last_ = T_map_last_;
}

bool Mapper::accepts(const RegistrationResult& match) const {
  return match.num_correspondences > 0 && match.inlier_share() > options_.min_inlier_share;
}

void Mapper::place(MappedScan& mapped, const Eigen::Isometry3d& guess, const std::optional<RegistrationResult>& to_local,
                   const std::optional<RegistrationResult>& to_prior, std::size_t num_points) {
  const bool local_holds = to_local && accepts(*to_local);
  const bool prior_holds = to_prior && accepts(*to_prior);
  const bool first = graph_.size() == 0;

  const PoseId k = graph_.add_pose(local_holds ? to_local->T_target_source : prior_holds ? to_prior->T_target_source : guess);
  if (!first) {
    const Eigen::Isometry3d T_previous_k = graph_.pose(k - 1).inverse() * (local_holds ? to_local->T_target_source : guess);
    graph_.add_between(k - 1, k, T_previous_k, local_holds ? information_a_point(*to_local, num_points) : carried_information());
  }
  if (prior_holds) graph_.add_absolute(k, to_prior->T_target_source, information_a_point(*to_prior, num_points));
  graph_.optimize_last();

  mapped.T_map_online = graph_.pose(k);
  if (to_local) mapped.local = figures_of(*to_local, local_holds);
  if (to_prior) mapped.prior = figures_of(*to_prior, prior_holds);
  const double share = to_prior ? static_cast<double>(to_prior->num_correspondences) / static_cast<double>(num_points) : 0;
  mapped.verdict = prior_holds ? (share < weak_share ? Verdict::weak : Verdict::anchored)
                   : !local_holds && !first ? Verdict::lost
                   : share < outside_share ? Verdict::outside_prior
                                           : Verdict::dead_reckoned;
  pose_of_scan_.push_back(k);
}

std::vector<MappedScan> Mapper::finish() const {
  const std::vector<Matrix6d> covariances = graph_.marginal_covariances();
  std::vector<MappedScan> scans = scans_;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i].T_map_sensor = scans[i].T_map_online;
    scans[i].covariance = covariances[pose_of_scan_[i]];
  }
  return scans;
}

}  // namespace priormap
