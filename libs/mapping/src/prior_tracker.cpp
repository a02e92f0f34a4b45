#include "prior_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <priormap/pointcloud/slope.hpp>
#include <priormap/registration/likely_places.hpp>

#include "confidence.hpp"
#include "street_view.hpp"

namespace priormap {
namespace {

// Scores a surfel.
constexpr double clear_gain = 0.02, least_score = 0.01, doubtful_score = 0.035;
constexpr double least_of_a_start = -0.01, least_of_any_start = -0.025;   // right ones had -0.0093 and more after some keyframes, wrong ones -0.02 to -0.06

double translation_information(const Matrix6d& information) { return information.bottomRightCorner<3, 3>().trace(); }

/// The scan with its normals, without roofs: they would lift the pose where no ground holds it.
SurfelCloud without_roofs(SurfelCloud scan, const Eigen::Matrix3d& R_map_sensor, double voxel_m) {
  tell_normals(scan, voxel_m);
  const Eigen::Matrix3f R = R_map_sensor.cast<float>();
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (!is_above_street((R * scan.surfels[i].mean).cast<double>()) || is_wall(R.row(2).dot(scan.normals[i]))) kept.push_back(i);
  return selected(scan, kept);
}

bool are_near(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double near_m, double near_rad) {
  const Vector6d apart = local_coordinates(a, b);
  return apart.tail<3>().norm() < near_m && apart.head<3>().norm() < near_rad;
}

}  // namespace

PriorTracker::PriorTracker(const TrackingOptions& options, double scan_voxel_m, const std::optional<NearTiles>& prior, const Eigen::Isometry3d& T_map_first)
    : options_(options), scan_voxel_m_(scan_voxel_m), registration_(options.registration), T_map_odom_(T_map_first), T_map_odom_lost_(T_map_first) {
  if (prior) prior_.emplace(*prior, PriorSurfels(options.prior));
}

Matrix6d PriorTracker::predicted_covariance(const Eigen::Isometry3d& T_odom_sensor) const {
  Vector6d drift;
  drift << Eigen::Vector3d::Constant(options_.drift_rad), Eigen::Vector3d::Constant(options_.drift_m);
  const Matrix6d A = adjoint(T_odom_sensor.inverse() * *T_odom_last_);
  const double steps = std::max(1.0, way_since_asked_m_ / options_.search_step_m);
  return A * covariance_ * A.transpose() + Matrix6d((steps * drift.cwiseAbs2()).asDiagonal());
}

bool PriorTracker::compares() const {
  constexpr int longest = 20;   // scans
  return num_heard_ < (farther_.empty() ? options_.start_keyframes : longest);
}

/// Unless it is there already.
void PriorTracker::propose(Hypotheses& hypotheses, const Eigen::Isometry3d& T_map_sensor, const Eigen::Isometry3d& T_odom_sensor) {
  const bool known = std::ranges::any_of(hypotheses, [&](const Hypothesis& h) { return are_near(h.T_map_odom * T_odom_sensor, T_map_sensor, 0.3, 0.01); });
  if (!known) hypotheses.push_back({T_map_sensor * T_odom_sensor.inverse()});
}

void PriorTracker::propose_places(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map) {
  constexpr double near_weight = 25;   // 1 m, 2.3 degrees
  const auto targets = map.targets(options_.prior_sigma_m, prior_weights_);
  const auto add = [&](const Eigen::Isometry3d& T_map_sensor) { propose(hypotheses_, T_map_sensor, T_odom_sensor); };
  const Eigen::Isometry3d T_start = T_map_odom_ * T_odom_sensor;
  const Eigen::Isometry3d T_given = registration_.align(scan, targets, T_start, PosePrior{T_start, start_information(T_start)}).T_map_scan;
  add(T_given);
  // Of a street that says little along it a loose start may slide by metres; what is near it is another place to be compared.
  add(registration_.align(scan, targets, T_start, PosePrior{T_start, near_weight * start_information(T_start)}).T_map_scan);
  if (located_) {
    for (const ScoredResult& other : registration_.search(scan, targets, T_given, options_.search, T_given)) add(other.match.T_map_scan);
  } else {
    for (const Eigen::Isometry3d& T : places_all_around(scan, T_odom_sensor, map)) add(T);
  }
}

std::vector<Eigen::Isometry3d> PriorTracker::places_all_around(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map) {
  constexpr std::size_t most_places = 40;
  constexpr double farthest_m = 120;   // scans reach on from there, and more of the prior is not held
  const double radius_m = std::min(farthest_m, lost_.radius_m + (T_odom_sensor.translation() - lost_.p_odom).norm());
  const auto targets = map.targets(options_.prior_sigma_m, prior_weights_);
  Eigen::Isometry3d centre = T_map_odom_lost_ * T_odom_sensor;
  centre.translation().head<2>() = centre_of_search().head<2>();   // who faces the other way has gone the other way
  std::vector<Eigen::Isometry3d> places = likely_places(scan, map.maps(), map.ground(), centre, radius_m, most_places);
  for (Eigen::Isometry3d& T : places) T = registration_.align(scan, targets, T).T_map_scan;
  return places;
}

/// Registers each hypothesis anew, from where the odometry leads it, and adds how well it fits.
void PriorTracker::hear(Hypotheses& hypotheses, const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map) {
  const auto targets = map.targets(options_.prior_sigma_m, prior_weights_), to_compare = map.targets(options_.prior_sigma_m, PriorSurfels::unweighted);
  const Matrix6d information = (Vector6d() << Eigen::Vector3d::Constant(1e4), Eigen::Vector3d::Constant(10)).finished().asDiagonal();
  for (Hypothesis& h : hypotheses) {
    const Eigen::Isometry3d T = h.T_map_odom * T_odom_sensor;
    const Eigen::Isometry3d T_aligned = registration_.align(scan, targets, T, PosePrior{T, information}).T_map_scan;
    h.sum += registration_.score(scan, to_compare, T_aligned, options_.search.sigma_m);
    h.num_surfels += static_cast<double>(scan.size());
    ++h.num_heard;
    h.T_map_odom = T_aligned * T_odom_sensor.inverse();
  }
}

const PriorTracker::Hypothesis& PriorTracker::best_of(const Hypotheses& hypotheses) { return *std::ranges::max_element(hypotheses, {}, &Hypothesis::score); }

double PriorTracker::best_score_elsewhere(const Hypotheses& hypotheses, const Eigen::Isometry3d& T_map_sensor, const Eigen::Isometry3d& T_odom_sensor) {
  constexpr double near_m = 3, near_rad = 0.1;
  std::optional<double> best;
  for (const Hypothesis& h : hypotheses) {
    Eigen::Isometry3d T = h.T_map_odom * T_odom_sensor;
    T.translation().z() = T_map_sensor.translation().z();   // where no ground is known, no height is
    if (!are_near(T, T_map_sensor, near_m, near_rad)) best = std::max(best.value_or(h.score()), h.score());
  }
  return best.value_or(std::numeric_limits<double>::infinity());
}

/// The pose given by the user is left for another only if the scans of the first stretch fit clearly better there. Beyond a gap the drive is where they fit about as well as they did before:
/// in a good prior 0.12 where it is and 0.02 at a wrong place, in a poor one 0.01 where it is.
void PriorTracker::compare_hypotheses(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map) {
  constexpr double usual_loss = 0.04;   // a surfel
  if (hypotheses_.empty()) propose_places(scan, T_odom_sensor, map);
  hear(hypotheses_, scan, T_odom_sensor, map);
  hear(farther_, scan, T_odom_sensor, map);
  const Hypothesis &given = hypotheses_.front(), &best = best_of(hypotheses_);
  const Hypothesis& chosen = best.score() - given.score() > clear_gain ? best : given;
  T_map_odom_ = chosen.T_map_odom;
  double score = chosen.score();
  const int enough = std::min(4, options_.start_keyframes);
  const bool fits = score > std::max(least_score, usual_score_ - usual_loss);
  if (++num_heard_ >= enough) located_ = located_ || (fits && score - best_score_elsewhere(hypotheses_, T_map_odom_ * T_odom_sensor, T_odom_sensor) > clear_gain);
  if (num_heard_ % enough == 0) {
    if (takes_farther_place(score, T_odom_sensor)) score = hypotheses_.front().score();
    drop_farther_places(score);
    const bool may_be_elsewhere = !lost_once_ && !started_elsewhere_ && score < (num_heard_ == enough ? doubtful_score : least_score);
    if (may_be_elsewhere && num_heard_ + enough <= options_.start_keyframes) look_farther(scan, T_odom_sensor, map);
  }
  const bool is_through = !compares();
  start_in_doubt_ = !lost_once_ && score < (is_through ? least_of_any_start : least_of_a_start);
  const bool in_vain = num_heard_ >= enough && !located_ && !fits;
  if (!is_through && !in_vain) return;
  hypotheses_ = {};
  farther_ = {};
  if (located_) {
    usual_score_ = score;
  } else {
    T_map_odom_ = T_map_odom_lost_;
    lost_step_m_ = std::max(lost_step_m_, std::min(2 * lost_step_m_, options_.keyframe_m));   // what was not found may not be there for long
    look_anew();
  }
}

/// Where the start that the user gave does not fit well, it may be wrong by more than it should be.
void PriorTracker::look_farther(const SurfelCloud& scan, const Eigen::Isometry3d& T_odom_sensor, const PriorSurfels& map) {
  for (const Eigen::Isometry3d& T : places_all_around(scan, T_odom_sensor, map)) propose(farther_, T, T_odom_sensor);
}

/// But the user is believed unless one place is right beyond doubt: then it takes the place of those near the start.
bool PriorTracker::takes_farther_place(double score_near_start, const Eigen::Isometry3d& T_odom_sensor) {
  const auto is_beyond_doubt = [&](const Hypothesis& h) {
    const double ahead = h.score() - std::max(score_near_start, best_score_elsewhere(farther_, h.T_map_odom * T_odom_sensor, T_odom_sensor));
    return h.score() >= least_score && ahead >= (h.num_heard < 8 ? 0.03 : h.num_heard < 12 ? 0.02 : 0.015);   // wrong ones were so by 0.011, 0.017 and 0.012
  };
  std::ranges::stable_sort(farther_, std::greater<>{}, &Hypothesis::score);
  const auto place = std::ranges::find_if(farther_, is_beyond_doubt);
  if (place == farther_.end()) return false;
  hypotheses_ = {*place};
  farther_ = {};
  T_map_odom_ = hypotheses_.front().T_map_odom;
  T_odom_last_.reset();
  return started_elsewhere_ = true;
}

/// What fits worse than the start, or far worse than the best, is looked at no more.
void PriorTracker::drop_farther_places(double score_near_start) {
  constexpr double far_behind = 0.03;
  if (farther_.empty()) return;
  const double least = std::max(score_near_start, best_of(farther_).score() - far_behind);
  std::erase_if(farther_, [&](const Hypothesis& h) { return h.score() < least; });
}

void PriorTracker::begin_anew(const LostPlace& lost) {
  constexpr double step_m = 3;
  if (!hypotheses_.empty() && located_) usual_score_ = hypotheses_.front().score();   // so far
  T_map_odom_lost_ = T_map_odom_;
  lost_ = lost;
  lost_once_ = true;
  start_in_doubt_ = false;
  lost_step_m_ = std::min(step_m, options_.search_step_m);
  look_anew();
}

void PriorTracker::look_anew() {
  T_odom_last_.reset();
  prior_weights_ = PriorSurfels::unweighted;
  hypotheses_ = {};
  farther_ = {};
  located_ = !prior_ || options_.start_keyframes == 0;   // nothing to be found in; or no looking
  num_heard_ = 0;
}

void PriorTracker::exchange(StateArchive& archive) {
  if (prior_) archive(*prior_);
  archive(T_map_odom_, T_odom_last_, p_odom_, way_since_asked_m_, heard_last_, covariance_, prior_weights_, hypotheses_, farther_, T_map_odom_lost_, lost_, lost_step_m_, lost_once_, start_in_doubt_, located_, started_elsewhere_, usual_score_, num_heard_);
}

void PriorTracker::go_on(const Eigen::Isometry3d& T_odom_sensor) {
  way_since_asked_m_ += (T_odom_sensor.translation() - p_odom_).norm();
  p_odom_ = T_odom_sensor.translation();
}

bool PriorTracker::asks() const {
  if (!prior_ || !T_odom_last_) return prior_.has_value();
  const bool is_held = !compares() && heard_last_;
  return way_since_asked_m_ >= (is_held ? options_.keyframe_m : located_ ? options_.search_step_m : lost_step_m_);
}

PriorMatch PriorTracker::word_of(const JointResult& match, std::size_t num_surfels) const {
  PriorMatch found;
  MatchFigures& figures = found.figures;
  double squares = 0;
  for (const TargetResult& layer : match.targets) {
    figures.num_correspondences += layer.num_correspondences;
    figures.num_inliers += layer.num_inliers;
    squares += static_cast<double>(layer.num_inliers) * layer.inlier_rmse_m * layer.inlier_rmse_m;
  }
  figures.inlier_rmse_m = figures.num_inliers ? std::sqrt(squares / static_cast<double>(figures.num_inliers)) : 0;
  figures.iterations = match.iterations;
  figures.converged = match.converged;
  found.share = std::min(1.0, static_cast<double>(figures.num_correspondences) / static_cast<double>(num_surfels));
  figures.accepted = found.share > options_.min_share && static_cast<double>(figures.num_inliers) > options_.min_inlier_share * static_cast<double>(figures.num_correspondences);
  return found;
}

std::optional<PriorMatch> PriorTracker::follow(const SurfelCloud& whole_scan, const Eigen::Isometry3d& T_odom_sensor) {
  if (whole_scan.empty()) return std::nullopt;
  const Eigen::Isometry3d guess = T_map_odom_ * T_odom_sensor;
  // Once the drive has been found in the prior, some thousand surfels hold it there as well as all.
  constexpr std::size_t most_surfels = 3000;
  const std::size_t stride = compares() ? 1 : (whole_scan.size() + most_surfels - 1) / most_surfels;
  const SurfelCloud scan = without_roofs(every(whole_scan, stride), guess.linear(), scan_voxel_m_);
  if (scan.empty()) return std::nullopt;
  const bool looks_all_around = !located_ || !farther_.empty();
  const PriorSurfels& map = prior_->around(looks_all_around ? centre_of_search() : guess.translation());   // no place is to be preferred
  const auto targets = map.targets(options_.prior_sigma_m, prior_weights_);
  if (compares()) compare_hypotheses(scan, T_odom_sensor, map);
  const Eigen::Isometry3d T_pred = T_map_odom_ * T_odom_sensor;
  JointResult match;
  if (T_odom_last_) {
    const Matrix6d information = predicted_covariance(T_odom_sensor).inverse();
    match = registration_.align(scan, targets, T_pred, PosePrior{T_pred, 0.5 * (information + information.transpose())});
  } else {
    const Eigen::Isometry3d& known = are_near(guess, T_pred, 10, 0.3) ? guess : T_pred;   // what is left for another place says nothing of that
    match = registration_.align(scan, targets, T_pred, PosePrior{known, start_information(known)});
  }
  const PriorMatch found = word_of(match, scan.size());
  const bool accepted = found.figures.accepted;
  if (accepted) {
    covariance_ = covariance_of(match.information);
    T_map_odom_ = match.T_map_scan * T_odom_sensor.inverse();
  } else {
    covariance_ = T_odom_last_ ? predicted_covariance(T_odom_sensor) : covariance_of(Matrix6d::Zero());
  }
  heard_last_ = accepted;
  T_odom_last_ = T_odom_sensor;
  way_since_asked_m_ = 0;
  for (std::size_t i = 0; i < prior_weights_.size(); ++i) {
    const double floor_m = std::max(options_.prior_floor_m, map.stated_sigma_m(i));
    prior_weights_[i] = 1 / (1 + translation_information(match.targets[i].information / targets[i].weight) * floor_m * floor_m / 3);
  }
  return found;
}

}  // namespace priormap
