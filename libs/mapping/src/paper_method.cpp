#include <Eigen/LU>
#include <algorithm>
#include <numbers>
#include <utility>

#include <priormap/mapping/motion.hpp>
#include <priormap/pointcloud/downsample.hpp>
#include <priormap/posegraph/pose_graph.hpp>
#include <priormap/registration/register_scan.hpp>

#include "confidence.hpp"
#include "mapping_method.hpp"

namespace priormap {
namespace {

PointCloud positions_of(const PointCloud& points) {
  PointCloud positions;
  positions.origin = points.origin;
  positions.xyz = points.xyz;
  return positions;
}

MatchFigures figures_of(const RegistrationResult& match, bool accepted) {
  return {match.num_correspondences, match.num_inliers, match.iterations, match.inlier_rmse_m, match.converged, accepted};
}

/// The published method (Kulmer et al., VEHITS 2025): the thinned scan point to point against the local map and, when the vehicle has moved, against the prior;
/// a pose graph joins the two frame by frame.
class PaperMethod : public MappingMethod {
 public:
  PaperMethod(const PaperOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first, int threads)
      : options_(options), threads_(threads), T_map_before_last_(first.T_map_sensor * first.motion.inverse()), T_map_last_(first.T_map_sensor),
        local_map_(options.voxels), graph_(options.graph) {
    if (prior) prior_.emplace(*prior, VoxelHashMap(options.voxels));
  }

  PrepareScan preparation() const override;
  MappedScan place(ReadyScan scan) override;
  std::vector<EstimatedPose> finish(const ReadScan&) override;
  void exchange(StateArchive& archive) override;

 private:
  bool accepts(const RegistrationResult& match) const { return match.num_correspondences > 0 && match.inlier_share() > options_.min_inlier_share; }
  bool stands_still(const RegistrationResult& to_local) const;
  void repeat_last(MappedScan& mapped);
  Verdict verdict_of(const std::optional<RegistrationResult>& to_local, const std::optional<RegistrationResult>& to_prior, std::size_t num_points) const;

  PaperOptions options_;
  int threads_;
  Eigen::Isometry3d T_map_before_last_, T_map_last_;
  std::optional<PriorWindow<VoxelHashMap>> prior_;
  VoxelHashMap local_map_;
  PoseGraph graph_;
  std::vector<PoseId> pose_of_scan_;
  Verdict last_verdict_ = Verdict::lost;
};

/// Information a point of the scan: the kernel widths of the pose graph then read as metres, whatever the number of points, and a map that only a corner of
/// the scan has met weighs little.
Matrix6d information_a_point(const RegistrationResult& match, std::size_t num_points) {
  return match.information / static_cast<double>(std::max<std::size_t>(num_points, 1));
}

PrepareScan PaperMethod::preparation() const {
  return [downsample_m = options_.downsample_m](const Scan& scan) {
    ReadyScan ready{facts_of(scan), {}, positions_of(scan.points), {}};
    ready.facts.motion_undone = false;   // the paper takes sweeps as they are
    ready.thinned = voxel_downsample_centroid(ready.points, downsample_m);
    return ready;
  };
}

MappedScan PaperMethod::place(ReadyScan scan) {
  MappedScan& mapped = scan.facts;
  const PointCloud& points = scan.thinned;
  const bool first = pose_of_scan_.empty();
  const Eigen::Isometry3d guess = first ? T_map_last_ : predict(T_map_before_last_, T_map_last_);

  std::optional<RegistrationResult> to_local, to_prior;
  if (!local_map_.empty()) {
    to_local = register_scan(points, local_map_, guess, options_.icp, threads_);
    mapped.local = figures_of(*to_local, accepts(*to_local));
    if (to_local->converged && stands_still(*to_local)) {
      repeat_last(mapped);
      return mapped;
    }
  }
  if (prior_) {
    to_prior = register_scan(points, prior_->around(guess.translation()), guess, options_.icp, threads_);
    mapped.prior = figures_of(*to_prior, accepts(*to_prior));
  }

  const bool by_local = to_local && accepts(*to_local), by_prior = to_prior && accepts(*to_prior);
  const PoseId k = graph_.add_pose(by_local ? to_local->T_target_source : by_prior ? to_prior->T_target_source : guess);
  if (k > 0) {
    if (by_local)
      graph_.add_between(k - 1, k, graph_.pose(k - 1).inverse() * to_local->T_target_source, information_a_point(*to_local, points.size()));
    else
      graph_.add_between(k - 1, k, graph_.pose(k - 1).inverse() * guess, carried_covariance().inverse());
  }
  if (by_prior) graph_.add_absolute(k, to_prior->T_target_source, information_a_point(*to_prior, points.size()));
  graph_.optimize_last();

  mapped.T_map_online = graph_.pose(k);
  mapped.verdict = last_verdict_ = verdict_of(to_local, to_prior, points.size());
  pose_of_scan_.push_back(k);
  const Eigen::Isometry3d motion_before = T_map_before_last_.inverse() * T_map_last_;
  T_map_before_last_ = first ? mapped.T_map_online * motion_before.inverse() : T_map_last_;
  T_map_last_ = mapped.T_map_online;
  // The whole scan, as the voxel map takes it: with the thinned one alone a start at speed is taken for a standstill.
  local_map_.insert(scan.points, T_map_last_);
  local_map_.remove_beyond(T_map_last_.translation(), options_.local_map_radius_m);
  return mapped;
}

/// Motion counts from the last pose that was added: creeping along adds up until it is seen. A vehicle that turns on the spot does not stand still.
bool PaperMethod::stands_still(const RegistrationResult& to_local) const {
  const Eigen::Isometry3d motion = T_map_last_.inverse() * to_local.T_target_source;
  return motion.translation().norm() < options_.min_motion_m && Eigen::AngleAxisd(motion.linear()).angle() < options_.min_turn_deg * std::numbers::pi / 180;
}

void PaperMethod::repeat_last(MappedScan& mapped) {
  mapped.T_map_online = T_map_last_;
  mapped.verdict = last_verdict_;
  mapped.standstill = true;
  pose_of_scan_.push_back(pose_of_scan_.back());
  T_map_before_last_ = T_map_last_;
}

/// A match to the local map that did not settle is no ground to call a pose anchored: the prior is dense enough to fit anywhere.
Verdict PaperMethod::verdict_of(const std::optional<RegistrationResult>& to_local, const std::optional<RegistrationResult>& to_prior, std::size_t num_points) const {
  const bool moved_on = !to_local || (accepts(*to_local) && to_local->converged);
  const double share = to_prior && num_points ? static_cast<double>(to_prior->num_correspondences) / static_cast<double>(num_points) : 0;
  if (!moved_on) return Verdict::lost;
  if (to_prior && accepts(*to_prior)) return share < weak_share ? Verdict::weak : Verdict::anchored;
  return share < outside_share ? Verdict::outside_prior : Verdict::dead_reckoned;
}

void PaperMethod::exchange(StateArchive& archive) {
  if (prior_) archive(*prior_);
  archive(T_map_before_last_, T_map_last_, local_map_, graph_, pose_of_scan_, last_verdict_);
}

/// Where the prior held no pose, they are as sure as the start was; without a prior they count from it.
std::vector<EstimatedPose> PaperMethod::finish(const ReadScan&) {
  const bool held = std::ranges::any_of(graph_.absolute_weights(), [](double weight) { return weight > 0; });
  if (prior_ && !held) graph_.add_absolute(0, graph_.pose(0), start_information(graph_.pose(0)));
  const std::vector<Matrix6d> covariances = graph_.marginal_covariances();
  std::vector<EstimatedPose> poses;
  for (const PoseId k : pose_of_scan_) poses.push_back({graph_.pose(k), covariances[k]});
  return poses;
}

}  // namespace

std::unique_ptr<MappingMethod> make_paper_method(const PaperOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first, int threads) {
  return std::make_unique<PaperMethod>(options, prior, first, threads);
}

}  // namespace priormap
