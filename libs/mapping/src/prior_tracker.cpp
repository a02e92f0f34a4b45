#include "prior_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "confidence.hpp"

namespace priormap {
namespace {

double translation_information(const Matrix6d& information) { return information.bottomRightCorner<3, 3>().trace(); }

/// The scan without roofs: level or sloping planes above the sensor. Their heights in a prior are often guessed, and would lift the pose where no ground holds it.
SurfelCloud without_roofs(const SurfelCloud& scan, const Eigen::Matrix3d& R_map_sensor, double voxel_m) {
  constexpr float level = 0.3f;
  const Eigen::Vector3f up = R_map_sensor.row(2).transpose().cast<float>();
  SurfelCloud kept{scan.origin, {}};
  kept.surfels.reserve(scan.size());
  for (const Surfel& surfel : scan.surfels)
    if (up.dot(surfel.mean) <= 0 || std::abs(up.dot(normal_of(surfel, voxel_m))) < level) kept.surfels.push_back(surfel);
  return kept;
}

}  // namespace

PriorTracker::PriorTracker(const TrackingOptions& options, double scan_voxel_m, const std::optional<NearTiles>& prior, const Eigen::Isometry3d& T_map_first)
    : options_(options), scan_voxel_m_(scan_voxel_m), registration_(options.registration), T_map_odom_(T_map_first) {
  if (prior) prior_.emplace(*prior, SurfelMap(options.prior));
}

Matrix6d PriorTracker::predicted_covariance(const Eigen::Isometry3d& T_odom_sensor) const {
  Vector6d drift;
  drift << Eigen::Vector3d::Constant(options_.drift_rad), Eigen::Vector3d::Constant(options_.drift_m);
  const Matrix6d A = adjoint(T_odom_sensor.inverse() * *T_odom_last_);
  return A * covariance_ * A.transpose() + Matrix6d(drift.cwiseAbs2().asDiagonal());
}

/// The pose given by the user is left for another only if the scans of the first stretch fit clearly better there.
void PriorTracker::compare_hypotheses(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const SurfelMap& map) {
  constexpr double clear_gain = 0.02;   // a surfel
  const JointTarget target{&map, options_.prior_sigma_m, prior_weight_}, unweighted{&map, options_.prior_sigma_m, 1};
  if (hypotheses_.empty()) {
    const Eigen::Isometry3d T_start = T_map_odom_ * T_odom_sensor;
    const Eigen::Isometry3d T_given = registration_.align(scan, {&target, 1}, T_start, PosePrior{T_start, start_information(T_start)}).T_map_scan;
    hypotheses_.push_back({T_given * T_odom_sensor.inverse(), 0});
    for (const ScoredResult& other : registration_.search(scan, {&target, 1}, T_given, options_.search))
      hypotheses_.push_back({other.match.T_map_scan * T_odom_sensor.inverse(), 0});
  }
  const Matrix6d information = (Vector6d() << Eigen::Vector3d::Constant(1e4), Eigen::Vector3d::Constant(10)).finished().asDiagonal();
  for (Hypothesis& h : hypotheses_) {
    const Eigen::Isometry3d T = h.T_map_odom * T_odom_sensor;
    const Eigen::Isometry3d T_aligned = registration_.align(scan, {&target, 1}, T, PosePrior{T, information}).T_map_scan;
    h.score += registration_.score(scan, {&unweighted, 1}, T_aligned, options_.search.sigma_m);
    h.T_map_odom = T_aligned * T_odom_sensor.inverse();
  }
  num_surfels_heard_ += scan.size();
  const Hypothesis& given = hypotheses_.front();
  const Hypothesis& best = *std::max_element(hypotheses_.begin(), hypotheses_.end(), [](const Hypothesis& a, const Hypothesis& b) { return a.score < b.score; });
  T_map_odom_ = (best.score - given.score > clear_gain * static_cast<double>(num_surfels_heard_) ? best : given).T_map_odom;
  if (++num_heard_ == options_.start_keyframes) hypotheses_.clear();
}

void PriorTracker::begin_anew() {
  T_odom_last_.reset();
  prior_weight_ = 1;
  hypotheses_.clear();
  num_heard_ = 0;
  num_surfels_heard_ = 0;
}

void PriorTracker::exchange(StateArchive& archive) {
  if (prior_) archive(*prior_);
  archive(T_map_odom_, T_odom_last_, covariance_, prior_weight_, hypotheses_, num_heard_, num_surfels_heard_);
}

bool PriorTracker::asks(const Eigen::Isometry3d& T_odom_sensor) const {
  return prior_ && !(T_odom_last_ && (T_odom_sensor.translation() - T_odom_last_->translation()).norm() < options_.keyframe_m);
}

std::optional<PriorMatch> PriorTracker::follow(const SurfelCloud& whole_scan, const Eigen::Isometry3d& T_odom_sensor) {
  if (whole_scan.empty() || !asks(T_odom_sensor)) return std::nullopt;
  const Eigen::Isometry3d guess = T_map_odom_ * T_odom_sensor;
  const SurfelCloud scan = without_roofs(whole_scan, guess.linear(), scan_voxel_m_);
  if (scan.empty()) return std::nullopt;
  const SurfelMap& map = prior_->around(guess.translation());
  JointTarget target{&map, options_.prior_sigma_m, prior_weight_};
  if (num_heard_ < options_.start_keyframes) compare_hypotheses(scan, T_odom_sensor, map);
  const Eigen::Isometry3d T_pred = T_map_odom_ * T_odom_sensor;
  JointResult match;
  if (T_odom_last_) {
    const Matrix6d information = predicted_covariance(T_odom_sensor).inverse();
    match = registration_.align(scan, {&target, 1}, T_pred, PosePrior{T_pred, 0.5 * (information + information.transpose())});
  } else {
    match = registration_.align(scan, {&target, 1}, T_pred, PosePrior{guess, start_information(guess)});
  }
  const TargetResult& to_prior = match.targets.front();
  PriorMatch found;
  found.share = static_cast<double>(to_prior.num_correspondences) / static_cast<double>(scan.size());
  found.information = to_prior.information / target.weight;
  const bool accepted = found.share > options_.min_share && to_prior.inlier_share() > options_.min_inlier_share;
  found.figures = {to_prior.num_correspondences, to_prior.num_inliers, match.iterations, to_prior.inlier_rmse_m, match.converged, accepted};
  if (accepted) {
    covariance_ = covariance_of(match.information);
    T_map_odom_ = match.T_map_scan * T_odom_sensor.inverse();
  } else {
    covariance_ = T_odom_last_ ? predicted_covariance(T_odom_sensor) : covariance_of(Matrix6d::Zero());
  }
  T_odom_last_ = T_odom_sensor;
  prior_weight_ = 1 / (1 + translation_information(found.information) * options_.prior_floor_m * options_.prior_floor_m / 3);
  return found;
}

}  // namespace priormap
