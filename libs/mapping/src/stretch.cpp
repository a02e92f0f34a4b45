#include "stretch.hpp"

#include <algorithm>
#include <chrono>

#include <priormap/mapping/motion.hpp>
#include <priormap/registration/scan_reducer.hpp>

#include "sweep_motion.hpp"

namespace priormap {
namespace {

Vector6d velocity_at_start(const ScanSource& source, const Stretch& stretch) {
  return steady_velocity(Eigen::Isometry3d::Identity(), motion_at_start(source, stretch.begin, stretch.last), period_at_start(source, stretch.begin, stretch.last));
}

}  // namespace

std::vector<Stretch> stretches_of(std::size_t first, std::size_t last, const StretchOptions& options) {
  const std::size_t count = last - first, parts = std::max<std::size_t>(1, count / static_cast<std::size_t>(options.scans));
  const auto overlap = static_cast<std::size_t>(options.overlap);
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < parts; ++i) {
    const std::size_t own = count * i / parts;
    stretches.push_back({first + own - std::min(own, overlap), first + own, first + count * (i + 1) / parts});
  }
  return stretches;
}

DrivenStretch drive(const Stretch& stretch, const ScanSource& source, const JointMethodOptions& options, const std::optional<Vector6d>& first_velocity) {
  using Clock = std::chrono::steady_clock;
  ScanReducer reducer(options.reduce_m);
  DrivenStretch driven{{}, {}, Odometry(options.odometry, first_velocity ? *first_velocity : velocity_at_start(source, stretch))};
  for (std::size_t i = stretch.begin; i < stretch.last; ++i) {
    const auto begin = Clock::now();
    const Scan scan = source.read(i);
    SurfelCloud surfels = reducer.reduce(scan.points);
    DrivenScan here{facts_of(scan), driven.odometry.step(surfels, scan.stamp_s)};
    here.mapped.step_s = std::chrono::duration<double>(Clock::now() - begin).count();
    (i < stretch.first ? driven.shared : driven.own).push_back(here);
  }
  return driven;
}

std::optional<Eigen::Isometry3d> T_odom_stretch(std::span<const ScanRecord> before, std::span<const DrivenScan> shared) {
  constexpr std::size_t compared = 10;
  constexpr double near_m = 0.1, near_rad = 0.01;
  if (before.size() < compared || shared.size() < compared) return std::nullopt;
  before = before.last(compared);
  shared = shared.last(compared);
  for (std::size_t i = 0; i < compared; ++i)
    if (!before[i].odometry.joined || !shared[i].step.joined) return std::nullopt;

  const auto T_before = [&](std::size_t i) -> const Eigen::Isometry3d& { return before[i].odometry.T_odom_sensor; };
  const auto T_own = [&](std::size_t i) -> const Eigen::Isometry3d& { return shared[i].step.T_odom_sensor; };
  // The mean over the scans: what a match errs by differs from scan to scan.
  Eigen::Isometry3d T = T_before(compared - 1) * T_own(compared - 1).inverse();
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), way = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < compared; ++i) turn += log_so3(Eigen::Quaterniond(T_before(i).linear() * (T * T_own(i)).linear().transpose())) / static_cast<double>(compared);
  T.linear() = (exp_so3(turn) * Eigen::Quaterniond(T.linear())).normalized().toRotationMatrix();
  for (std::size_t i = 0; i < compared; ++i) way += (T_before(i).translation() - T.linear() * T_own(i).translation()) / static_cast<double>(compared);
  T.translation() = way;

  for (std::size_t i = 0; i < compared; ++i) {
    const Vector6d apart = local_coordinates(T_before(i), T * T_own(i));
    if (apart.tail<3>().norm() > near_m || apart.head<3>().norm() > near_rad) return std::nullopt;
  }
  return T;
}

}  // namespace priormap
