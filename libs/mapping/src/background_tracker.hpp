#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <future>
#include <optional>

#include <priormap/core/state_archive.hpp>

#include "prior_tracker.hpp"

namespace priormap {

/// Asks a PriorTracker in a thread of its own, so that the odometry goes on meanwhile. What it says counts from the second scan after the one that was asked of, however long it
/// took: what comes out does not depend on timing. The first scan of a drive waits for the word: it says where the drive begins.
class BackgroundTracker {
 public:
  /// @param threads  1: asked in the caller's thread, with the same result
  BackgroundTracker(PriorTracker tracker, int threads) : tracker_(std::move(tracker)), threads_(threads), T_map_odom_(tracker_.T_map_odom()) {}
  ~BackgroundTracker();
  BackgroundTracker(const BackgroundTracker&) = delete;
  BackgroundTracker& operator=(const BackgroundTracker&) = delete;

  /// Takes each scan of the drive in turn. @param surfels  gives the scan's, where the prior is to be asked; empty where nobody knows where the scan was taken
  /// @return what is heard with this scan, if anything. @throws what asking threw
  std::optional<PriorMatch> follow(const Eigen::Isometry3d& T_odom_sensor, const std::function<SurfelCloud()>& surfels);
  /// As PriorTracker::begin_anew.
  void begin_anew();
  /// By what has been heard.
  const Eigen::Isometry3d& T_map_odom() const { return T_map_odom_; }
  /// Ends what is being asked. @throws what asking threw
  void wait();
  void exchange(StateArchive& archive);

 private:
  std::optional<PriorMatch> hear();

  PriorTracker tracker_;
  int threads_;
  Eigen::Isometry3d T_map_odom_;
  int scans_until_heard_ = 0;               // 0: nothing was asked
  std::optional<PriorMatch> word_;          // of what was asked, once it is said
  std::future<std::optional<PriorMatch>> asking_;
};

}  // namespace priormap
