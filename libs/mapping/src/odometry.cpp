#include "odometry.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "sweep_motion.hpp"

namespace priormap {
namespace {

SurfelCloud every(const SurfelCloud& scan, std::size_t stride) {
  SurfelCloud some{scan.origin, {}};
  for (std::size_t i = 0; i < scan.size(); i += std::max<std::size_t>(stride, 1)) some.surfels.push_back(scan.surfels[i]);
  return some;
}

Eigen::Vector3d turn_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) { return log_so3(Eigen::Quaterniond(a.linear().transpose() * b.linear())); }

}  // namespace

/// Ground fits ground anywhere: a scan of another street has more than half its planes fit. But never as they did in the scans before.
bool UsualFit::admit(const TargetResult& match, bool after_loss) const {
  constexpr int least = 5;
  if (count_ < least) return true;
  const double share = match.inlier_share() / share_, rmse = match.inlier_rmse_m / rmse_m_;
  return after_loss ? share > 0.85 && rmse < 1.8 : share > 0.7 || rmse < 2;
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
  rmse_m_ += weight * (match.inlier_rmse_m - rmse_m_);
}

Odometry::Odometry(const OdometryOptions& options, const Vector6d& first_velocity)
    : options_(options), registration_(options.registration), local_map_(options.local_map), T_odom_last_(Eigen::Isometry3d::Identity()), velocity_(first_velocity) {}

/// Stamps that stand still say nothing, and no motion stays steady for long.
double Odometry::time_since_last(double stamp_s) const {
  constexpr double usual_s = 0.1;
  const double duration_s = stamp_s - stamp_last_s_;
  return duration_s > 0 ? std::min(duration_s, longest_steady_s) : usual_s;
}

OdometryStep Odometry::matched(const SurfelCloud& scan, const Eigen::Isometry3d& guess) {
  const std::array targets = {JointTarget{&local_map_, options_.local_sigma_m, 1.0}};
  const JointResult match = registration_.align(scan, targets, guess);
  const TargetResult& local = match.targets.front();
  OdometryStep found;
  const double share = scan.empty() ? 0 : static_cast<double>(local.num_correspondences) / static_cast<double>(scan.size());
  found.joined = share > options_.min_share && local.inlier_share() > options_.min_inlier_share && fits_.admit(local, num_lost_ > 0);
  found.T_odom_sensor = found.joined ? match.T_map_scan : guess;
  if (found.joined) found.information = local.information;
  found.figures = {local.num_correspondences, local.num_inliers, match.iterations, local.inlier_rmse_m, match.converged, found.joined};
  return found;
}

/// Where the motion carried on leads; but a platform that rocks turns back as often as it turns on: there any tilt it may have come to is tried, for the rings of the lasers on the ground fit
/// where nothing has turned, though the scan as a whole fits worse. For their sake the yaw stays as carried on.
OdometryStep Odometry::matched_after(const SurfelCloud& scan, double duration_s) {
  constexpr double least_rad = 0.01, margin = 1.5, widest_rad = 0.15;
  const Eigen::Isometry3d carried = moved_on(T_odom_last_, velocity_, duration_s);
  if (rocking_rad_ < least_rad) return matched(scan, carried);
  Eigen::Isometry3d upright = carried;
  upright.linear() = T_odom_last_.linear() * exp_so3({0, 0, turn_between(T_odom_last_, carried).z()}).toRotationMatrix();
  PoseSearchOptions tilts;
  tilts.radius_m = tilts.yaw_rad = 0;
  tilts.tilt_rad = std::min(margin * rocking_rad_, widest_rad);
  tilts.refined = 3;
  const std::array targets = {JointTarget{&local_map_, options_.local_sigma_m, 1.0}};
  OdometryStep found = matched(scan, registration_.search(scan, targets, upright, tilts).front().match.T_map_scan);
  if (!found.joined) found.T_odom_sensor = carried;
  return found;
}

/// The sweep is straightened by the motion so far, and once more where the match shows another.
OdometryStep Odometry::matched_in_motion(SurfelCloud& scan, double duration_s) {
  constexpr double least_m = 0.01, range_m = 30;
  const double longest_s = longest_time_s(scan);
  if (longest_s == 0) return matched_after(scan, duration_s);
  const SurfelCloud raw = scan;
  undo_motion(scan, velocity_);
  const OdometryStep found = matched_after(scan, duration_s);
  if (!found.joined || num_lost_ > 0) return found;   // after a loss the way since the last match tells no steady motion
  const Vector6d velocity = steady_velocity(T_odom_last_, found.T_odom_sensor, duration_s), change = velocity - velocity_;
  if (longest_s * (change.tail<3>().norm() + range_m * change.head<3>().norm()) < least_m) return found;
  scan = raw;
  undo_motion(scan, velocity);
  return matched(scan, found.T_odom_sensor);
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

/// Scans may be missing in a recording. Where one fits worse than usual, it is looked for where the sensor may be by then.
std::optional<OdometryStep> Odometry::found_beyond_gap(const SurfelCloud& scan, const OdometryStep& found, double duration_s) {
  constexpr double least_way_m = 0.1;
  if (num_lost_ > 0 || !fits_.doubts(found.figures)) return std::nullopt;
  if (velocity_.tail<3>().norm() * duration_s >= least_way_m)
    if (const auto straight_on = found_straight_on(scan)) return straight_on;
  return found_around(scan, found);
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
  constexpr int search_each = 10;   // doubted scan, while nothing is found
  if (num_to_search_ > 0 && --num_to_search_ > 0) return std::nullopt;
  num_to_search_ = search_each;
  constexpr std::size_t surfels = 150;
  const SurfelCloud some = every(scan, scan.size() / surfels);
  const PoseSearchOptions starts{.radius_m = radius_m, .yaw_rad = 1.2, .step_m = 3, .step_rad = 0.1, .surfels = surfels, .refined = std::numeric_limits<int>::max()};
  Eigen::Isometry3d centre = T_odom_last_;
  if (const double speed_m_s = velocity_.tail<3>().norm(); speed_m_s > 0) centre.translation() += (radius_m - behind_m) / speed_m_s * (centre.linear() * velocity_.tail<3>());
  const std::array targets = {JointTarget{&local_map_, options_.local_sigma_m, 1.0}};
  const OdometryStep elsewhere = matched(scan, registration_.search(some, targets, centre, starts).front().match.T_map_scan);
  if (!elsewhere.joined || !fits_.may_be(elsewhere.figures)) return std::nullopt;
  const auto fit = [&](const Eigen::Isometry3d& T) { return registration_.score(scan, targets, T, 0) / static_cast<double>(scan.size()); };
  if (fit(elsewhere.T_odom_sensor) < fit(found.T_odom_sensor) + clear_gain) return std::nullopt;
  num_to_search_ = 0;
  return elsewhere;
}

/// The stamps tell of a gap, and the street beyond it is another: straight on, for no turn lasts that long.
OdometryStep Odometry::begun_anew(SurfelCloud scan, double stamp_s) {
  constexpr double longest_s = 10;
  Vector6d straight_on = velocity_;
  straight_on.head<3>().setZero();
  const Eigen::Isometry3d T = moved_on(T_odom_last_, straight_on, std::min(stamp_s - stamp_last_s_, longest_s));
  *this = Odometry(options_, straight_on);
  T_odom_last_ = T;
  OdometryStep found = step(scan, stamp_s);
  found.began_anew = true;
  return found;
}

/// While lost. A gap in the recording, perhaps: the old street may never come back.
OdometryStep Odometry::followed_apart(SurfelCloud scan, double stamp_s, const Eigen::Isometry3d& guess) {
  constexpr int give_up_after = 100;
  if (!apart_) {
    apart_ = std::make_unique<Odometry>(options_, velocity_);
    apart_->T_odom_last_ = guess;
  }
  OdometryStep found = apart_->step(scan, stamp_s);
  if (apart_->apart_) apart_ = std::move(apart_->apart_);   // lost there as well: what came since then counts
  found.joined = false;
  if (++num_lost_ < give_up_after && !found.began_anew) return found;   // a gap told by the stamps while lost is one as well
  found.began_anew = true;
  const auto begun = std::exchange(apart_, nullptr);
  *this = std::move(*begun);
  return found;
}

OdometryStep Odometry::step(SurfelCloud& scan, double stamp_s) {
  constexpr double fading = 0.9;   // a scan
  OdometryStep found;
  found.T_odom_sensor = T_odom_last_;
  found.velocity = velocity_;
  if (local_map_.empty()) {
    undo_motion(scan, velocity_);
  } else {
    const double duration_s = time_since_last(stamp_s);
    const SurfelCloud raw = scan;
    found = matched_in_motion(scan, duration_s);
    SurfelCloud as_before = raw;   // straightened by the motion so far: a false match shows a false one
    undo_motion(as_before, velocity_);
    const auto beyond_gap = found_beyond_gap(as_before, found, duration_s);
    if (beyond_gap) {
      found = *beyond_gap;
      scan = std::move(as_before);
    }
    const Eigen::Isometry3d guess = found.T_odom_sensor;
    if (!found.joined && num_lost_ > 0) found = found_again(scan);
    const bool gap_is_told = stamp_s - stamp_last_s_ > std::max(longest_steady_s, 3 * usual_period_s_);
    if (!beyond_gap && num_lost_ == 0 && gap_is_told && (!found.joined || fits_.doubts(found.figures))) return begun_anew(raw, stamp_s);
    if (!found.joined) return followed_apart(raw, stamp_s, guess);
    fits_.take(found.figures);
    if (!beyond_gap && num_lost_ == 0) {
      usual_period_s_ = stamp_s - stamp_last_s_;
      velocity_ = steady_velocity(T_odom_last_, found.T_odom_sensor, duration_s);
      rocking_rad_ = std::max(turn_between(T_odom_last_, found.T_odom_sensor).head<2>().norm(), fading * rocking_rad_);
    }
    num_lost_ = 0;
    apart_.reset();
    T_odom_last_ = found.T_odom_sensor;
    found.velocity = velocity_;
    if (beyond_gap) velocity_.head<3>().setZero();   // how it turns now is not known
  }
  stamp_last_s_ = stamp_s;
  local_map_.insert(scan, found.T_odom_sensor);
  local_map_.remove_beyond(found.T_odom_sensor.translation(), options_.local_map_radius_m);
  return found;
}

void Odometry::exchange(StateArchive& archive) {
  archive(local_map_, T_odom_last_, stamp_last_s_, velocity_, rocking_rad_, usual_period_s_, fits_, num_lost_, num_to_search_);
  bool is_lost = apart_ != nullptr;
  archive(is_lost);
  if (!is_lost) return apart_.reset();
  if (archive.reading()) apart_ = std::make_unique<Odometry>(options_, velocity_);
  apart_->exchange(archive);
}

}  // namespace priormap
