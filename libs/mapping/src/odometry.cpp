#include "odometry.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "sweep_motion.hpp"

namespace priormap {

/// Ground fits ground anywhere: a scan of another street has more than half its planes fit. But never as they did in the scans before.
bool UsualFit::admit(const TargetResult& match, bool after_loss) const {
  constexpr int least = 5;
  constexpr double least_known = 0.2;   // of what is usual
  if (count_ < least) return true;
  if (static_cast<double>(match.num_correspondences) < least_known * num_known_) return false;
  const double share = match.inlier_share() / share_, rmse = match.inlier_rmse_m / rmse_m_;
  if (after_loss) return share > 0.96 && rmse < 1.8;
  return (share > 0.7 || rmse < 2) && (share > 0.95 || rmse < 3);   // on flat ground nine tenths of another street fit
}

bool UsualFit::has_usual_share(const MatchFigures& match) const {
  constexpr double least_share = 0.85;   // of what is usual
  return static_cast<double>(match.num_inliers) >= least_share * share_ * static_cast<double>(match.num_correspondences);
}

bool UsualFit::doubts(const MatchFigures& match) const {
  constexpr int least = 5;
  constexpr double most_rmse = 1.8;   // of what is usual
  if (count_ < least || match.num_correspondences == 0) return false;
  return !has_usual_share(match) || match.inlier_rmse_m > most_rmse * rmse_m_;
}

bool UsualFit::may_be(const MatchFigures& match) const {
  constexpr double most_rmse = 3;
  return has_usual_share(match) && match.inlier_rmse_m < most_rmse * rmse_m_;
}

void UsualFit::take(const MatchFigures& match) {
  constexpr double share_of_new = 0.1;
  const double share = static_cast<double>(match.num_inliers) / static_cast<double>(match.num_correspondences);
  const double weight = count_++ ? share_of_new : 1;
  share_ += weight * (share - share_);
  num_known_ += weight * (static_cast<double>(match.num_correspondences) - num_known_);
  rmse_m_ += weight * (match.inlier_rmse_m - rmse_m_);
}

Odometry::Odometry(const OdometryOptions& options, const Vector6d& first_velocity)
    : options_(options), registration_(options.registration), local_map_(options.local_map), T_odom_last_(Eigen::Isometry3d::Identity()), velocity_(first_velocity) {}

/// Stamps that stand still or go back say nothing; nor does by how much the middles of two such sweeps differ.
double Odometry::time_since_last(double middle_s) const {
  constexpr double usual_s = 0.1;
  const double duration_s = middle_s - middle_last_s_;
  if (stamp_goes_on_ && duration_s > 0) return duration_s;
  return usual_period_s_ > 0 ? usual_period_s_ : usual_s;
}

/// No vehicle changes its speed much faster: where the street binds nothing, as in a tunnel, it goes on as before; but no motion stays steady for long.
PosePrior Odometry::steady(double duration_s) const {
  constexpr double usual_m_s2 = 10, least_m = 0.1;   // stamps jitter
  duration_s = std::min(duration_s, longest_steady_s);
  const double sigma_m = std::max(least_m, usual_m_s2 * duration_s * duration_s);
  const Vector6d information = (Vector6d() << Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(1 / (sigma_m * sigma_m))).finished();
  return {moved_on(T_odom_last_, velocity_, duration_s), information.asDiagonal()};
}

OdometryStep Odometry::matched(const SurfelCloud& scan, const Eigen::Isometry3d& guess, const std::optional<PosePrior>& prior) {
  const std::array targets = {JointTarget{&local_map_, options_.local_sigma_m, 1.0}};
  const JointResult match = registration_.align(scan, targets, guess, prior);
  const TargetResult& local = match.targets.front();
  OdometryStep found;
  const double share = scan.empty() ? 0 : static_cast<double>(local.num_correspondences) / static_cast<double>(scan.size());
  found.joined = share > options_.min_share && local.inlier_share() > options_.min_inlier_share && fits_.admit(local, num_lost_ > 0);
  found.T_odom_sensor = match.T_map_scan;
  if (found.joined) found.information = local.information;
  found.figures = {local.num_correspondences, local.num_inliers, match.iterations, local.inlier_rmse_m, match.converged, found.joined};
  return found;
}

/// The sweep is straightened by the motion so far, and once more where the match shows another.
OdometryStep Odometry::matched_in_motion(const SurfelCloud& raw, SurfelCloud& scan, double duration_s) {
  constexpr double least_m = 0.01, range_m = 30;
  const double longest_s = longest_time_s(scan);
  const PosePrior carried_on = steady(duration_s);
  undo_motion(scan, velocity_);
  const OdometryStep found = matched(scan, carried_on.T_map_scan, carried_on);
  if (longest_s == 0 || num_lost_ > 0) return found;   // after a loss the way since the last match tells no steady motion
  const Vector6d velocity = steady_velocity(T_odom_last_, found.T_odom_sensor, duration_s), change = velocity - velocity_;
  if (longest_s * (change.tail<3>().norm() + range_m * change.head<3>().norm()) < least_m) return found;
  scan = raw;
  undo_motion(scan, velocity);
  return matched(scan, found.T_odom_sensor, carried_on);   // where it turns suddenly, a scan may fit only now
}

/// While lost, the local map stays as it was: the way back is looked for around the last good pose, now and then in a wider circle.
OdometryStep Odometry::found_again(const SurfelCloud& scan) {
  constexpr int search_each = 10;
  constexpr double wider_m = 0.15, widest_m = 20;   // a lost scan, in all
  OdometryStep found = matched(scan, T_odom_last_);
  if (found.joined || scan.empty() || num_lost_ % search_each != 0) return found;
  const std::array targets = {JointTarget{&local_map_, options_.local_sigma_m, 1.0}};
  PoseSearchOptions circle = options_.search;
  circle.radius_m = std::min(circle.radius_m + wider_m * num_lost_, widest_m);
  return matched(scan, registration_.search(scan, targets, T_odom_last_, circle).front().match.T_map_scan);
}

/// Scans may be missing in a recording. Where one fits worse than usual, it is looked for where the sensor may be by then. That takes as long as hundreds of scans: it may be
/// done for three of them in a row, but for one in ten in the long run.
bool Odometry::find_beyond_gap(const SurfelCloud& raw, SurfelCloud& scan, OdometryStep& found, double duration_s) {
  constexpr double least_way_m = 0.1;
  constexpr int rest_after_search = 10, longest_rest = 30;   // scans
  if (!fits_.doubts(found.figures) || num_to_rest_ + rest_after_search > longest_rest) return false;
  num_to_rest_ += rest_after_search;
  SurfelCloud as_before = raw;   // straightened by the motion so far: a false match shows a false one
  undo_motion(as_before, velocity_);
  std::optional<OdometryStep> beyond;
  if (velocity_.tail<3>().norm() * duration_s >= least_way_m) beyond = found_straight_on(as_before);
  if (beyond && found.joined && beyond->figures.num_inliers < found.figures.num_inliers) beyond.reset();
  if (!beyond) beyond = found_around(as_before, found);
  if (!beyond) return false;
  found = *beyond;
  scan = std::move(as_before);
  return true;
}

/// Where the motion carried on would have led, until it fits as usual.
std::optional<OdometryStep> Odometry::found_straight_on(const SurfelCloud& scan) {
  constexpr double farthest_m = 40, step_m = 1;
  for (double way_m = step_m; way_m <= farthest_m; way_m += step_m) {
    const OdometryStep ahead = matched(scan, moved_on(T_odom_last_, velocity_, way_m / velocity_.tail<3>().norm()));
    if (ahead.joined && !fits_.doubts(ahead.figures)) return ahead;
  }
  return std::nullopt;
}

/// Around what lies ahead, also round a corner: starts so near each other that registering some of the surfels leads from one of them to the right place, where all fit far better.
std::optional<OdometryStep> Odometry::found_around(const SurfelCloud& scan, const OdometryStep& found) {
  constexpr double radius_m = 20, behind_m = 4, clear_gain = 0.05;   // a surfel
  constexpr std::size_t surfels = 150;
  SurfelCloud some = every(scan, std::max<std::size_t>(scan.size() / surfels, 1));
  some.few_lasers = false;   // the wider kernel was not tried here
  const PoseSearchOptions starts{.radius_m = radius_m, .yaw_rad = 1.2, .step_m = 3, .step_rad = 0.1, .surfels = surfels, .refined = std::numeric_limits<int>::max()};
  Eigen::Isometry3d centre = T_odom_last_;
  if (const double speed_m_s = velocity_.tail<3>().norm(); speed_m_s > 0) centre.translation() += (radius_m - behind_m) / speed_m_s * (centre.linear() * velocity_.tail<3>());
  const std::array targets = {JointTarget{&local_map_, options_.local_sigma_m, 1.0}};
  const OdometryStep elsewhere = matched(scan, registration_.search(some, targets, centre, starts).front().match.T_map_scan);
  if (!elsewhere.joined || !fits_.may_be(elsewhere.figures)) return std::nullopt;
  const auto fit = [&](const Eigen::Isometry3d& T) { return registration_.score(scan, targets, T, 0) / static_cast<double>(scan.size()); };
  if (fit(elsewhere.T_odom_sensor) < fit(found.T_odom_sensor) + clear_gain) return std::nullopt;
  return elsewhere;
}

bool Odometry::gap_is_told(double middle_s) const { return middle_s - middle_last_s_ > std::max(longest_steady_s, 3 * usual_period_s_); }

/// By the middle of the sweep, where no turn lasts that long.
Eigen::Isometry3d Odometry::straight_on(double middle_s) const {
  constexpr double longest_s = 10;
  Vector6d velocity = velocity_;
  velocity.head<3>().setZero();
  return moved_on(T_odom_last_, velocity, std::min(middle_s - middle_last_s_, longest_s));
}

/// Who was lost so long may have gone anywhere by then, and faster than before; but what is too far to look for all around lies straight on.
LostPlace Odometry::lost_place(double middle_s) const {
  constexpr double least_m = 20, faster_m_s = 5, farthest_m = 100;
  const double lost_s = std::max(middle_s - middle_last_s_, num_lost_ * usual_period_s_), speed_m_s = velocity_.tail<3>().norm();
  const bool is_far = least_m + lost_s * speed_m_s > farthest_m;
  return {(is_far ? straight_on(middle_s) : T_odom_last_).translation(), std::min(farthest_m, least_m + lost_s * (speed_m_s + faster_m_s))};
}

/// The scans from here on are followed apart, from where the first of them is guessed to be. Where the stamps tell of a gap, the street beyond it is another: it lies straight on, and the old one
/// is soon given up; a scan or two that are hidden from it may still come by.
void Odometry::get_lost(const Eigen::Isometry3d& guess, double middle_s) {
  constexpr int usual_patience = 100, patience_beyond_gap = 5;   // scans
  const bool told = gap_is_told(middle_s);
  num_to_give_up_ = told ? patience_beyond_gap : usual_patience;
  Vector6d velocity = velocity_;
  if (told) velocity.head<3>().setZero();
  apart_ = std::make_unique<Odometry>(options_, velocity);
  apart_->T_odom_last_ = told ? straight_on(middle_s) : guess;
}

/// While lost. A gap in the recording, perhaps: the old street may never come back.
OdometryStep Odometry::followed_apart(SurfelCloud scan, double middle_s) {
  constexpr int patience_after_another = 12, least_street = 20;   // scans: one search for the old street; what is no passing lorry
  apart_->stamp_goes_on_ = stamp_goes_on_;
  OdometryStep found = apart_->step_in_middle(scan, middle_s);
  if (apart_->apart_) {   // lost there as well: what came since then counts. If that was another street, the old one is back or never comes
    num_to_give_up_ = std::min(num_to_give_up_, apart_->num_to_give_up_ + 1);
    if (apart_->num_in_map_ >= least_street) num_to_give_up_ = std::min(num_to_give_up_, patience_after_another);
    apart_ = std::move(apart_->apart_);
  }
  ++num_lost_;
  found.joined = false;
  found.began_anew = --num_to_give_up_ == 0;
  if (!found.began_anew) return found;
  found.num_followed = apart_->num_in_map_ - 1;
  found.lost = lost_place(middle_s);
  const auto begun = std::exchange(apart_, nullptr);
  begun->stamp_last_s_ = stamp_last_s_;
  *this = std::move(*begun);
  return found;
}

/// The pose in the middle of a sweep depends least on the motion by which the sweep is straightened; at its begin or end an error in one would feed that in the other.
OdometryStep Odometry::step(SurfelCloud& scan, double stamp_s) {
  const double middle_s = mean_time_s(scan);
  count_times_from(scan, middle_s);
  constexpr double least_period_s = 1e-3;
  stamp_goes_on_ = stamp_s - std::exchange(stamp_last_s_, stamp_s) >= least_period_s;
  if (local_map_.empty()) T_odom_last_ = moved_on(T_odom_last_, velocity_, middle_s);   // `odom` lies at the first stamp
  OdometryStep found = step_in_middle(scan, stamp_s + middle_s);
  if (middle_s == 0) return found;
  found.middle_s = middle_s;
  const Eigen::Isometry3d T_middle = found.T_odom_sensor;
  found.T_odom_sensor = moved_on(T_middle, found.velocity, -middle_s);
  const Eigen::Isometry3d T_middle_stamp = T_middle.inverse() * found.T_odom_sensor;
  const Matrix6d A = adjoint(T_middle_stamp);
  found.information = A.transpose() * found.information * A;
  move(scan, T_middle_stamp.inverse());
  return found;
}

void Odometry::amend(OdometryStep& step, const Vector6d& velocity) {
  step.T_odom_sensor = moved_on(moved_on(step.T_odom_sensor, step.velocity, step.middle_s), velocity, -step.middle_s);
  step.velocity = velocity;
}

OdometryStep Odometry::step_in_middle(SurfelCloud& scan, double middle_s) {
  OdometryStep found;
  found.T_odom_sensor = T_odom_last_;
  found.velocity = velocity_;
  if (num_to_rest_ > 0) --num_to_rest_;
  if (local_map_.empty()) {
    undo_motion(scan, velocity_);
  } else {
    const double duration_s = time_since_last(middle_s);
    const SurfelCloud raw = scan;
    found = matched_in_motion(raw, scan, duration_s);
    bool beyond_gap = false;
    if (num_lost_ > 0) {
      if (!found.joined) found = found_again(scan);
    } else if (!found.joined || fits_.doubts(found.figures)) {
      beyond_gap = find_beyond_gap(raw, scan, found, duration_s);
      if (!beyond_gap && gap_is_told(middle_s)) found.joined = false;
      if (!found.joined) get_lost(steady(duration_s).T_map_scan, middle_s);
    }
    if (!found.joined) return followed_apart(raw, middle_s);
    fits_.take(found.figures);
    if (!beyond_gap && num_lost_ == 0) {
      usual_period_s_ = duration_s;
      velocity_ = steady_velocity(T_odom_last_, found.T_odom_sensor, duration_s);
    }
    num_lost_ = 0;
    apart_.reset();
    T_odom_last_ = found.T_odom_sensor;
    found.velocity = velocity_;
    if (beyond_gap) velocity_.head<3>().setZero();   // how it turns now is not known
  }
  middle_last_s_ = middle_s;
  ++num_in_map_;
  local_map_.insert(scan, found.T_odom_sensor);
  local_map_.remove_beyond(found.T_odom_sensor.translation(), options_.local_map_radius_m);
  return found;
}

void Odometry::exchange(StateArchive& archive) {
  archive(local_map_, T_odom_last_, stamp_last_s_, middle_last_s_, velocity_, usual_period_s_, fits_, num_lost_, num_in_map_, num_to_rest_, num_to_give_up_);
  bool is_lost = apart_ != nullptr;
  archive(is_lost);
  if (!is_lost) return apart_.reset();
  if (archive.reading()) apart_ = std::make_unique<Odometry>(options_, velocity_);
  apart_->exchange(archive);
}

}  // namespace priormap
