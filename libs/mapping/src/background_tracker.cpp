#include "background_tracker.hpp"

#include <utility>

namespace priormap {

BackgroundTracker::~BackgroundTracker() {
  if (asking_.valid()) asking_.wait();
}

void BackgroundTracker::wait() {
  if (asking_.valid()) word_ = asking_.get();
}

std::optional<PriorMatch> BackgroundTracker::hear() {
  wait();
  scans_until_heard_ = 0;
  T_map_odom_ = tracker_.T_map_odom();
  return std::exchange(word_, std::nullopt);
}

std::optional<PriorMatch> BackgroundTracker::follow(const Eigen::Isometry3d& T_odom_sensor, const std::function<SurfelCloud()>& surfels) {
  constexpr int heard_after = 2;
  std::optional<PriorMatch> heard;
  if (scans_until_heard_ > 0) {
    if (--scans_until_heard_ > 0) return std::nullopt;
    heard = hear();
  }
  if (!surfels || !tracker_.asks(T_odom_sensor)) return heard;
  const bool waits = tracker_.is_fresh();
  if (threads_ > 1)
    asking_ = std::async(std::launch::async, [this, scan = surfels(), T_odom_sensor] { return tracker_.follow(scan, T_odom_sensor); });
  else
    word_ = tracker_.follow(surfels(), T_odom_sensor);
  if (waits) return hear();
  scans_until_heard_ = heard_after;
  return heard;
}

void BackgroundTracker::begin_anew() {
  hear();
  tracker_.begin_anew();
}

void BackgroundTracker::exchange(StateArchive& archive) {
  wait();
  archive(tracker_, T_map_odom_, scans_until_heard_, word_);
}

}  // namespace priormap
