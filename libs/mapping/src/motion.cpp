#include <priormap/mapping/motion.hpp>

#include <array>

#include <priormap/registration/register_joint.hpp>
#include <priormap/registration/scan_reducer.hpp>
#include <priormap/registration/surfel_map.hpp>

namespace priormap {

Eigen::Isometry3d predict(const Eigen::Isometry3d& T_map_before_last, const Eigen::Isometry3d& T_map_last) {
  const Eigen::Quaterniond before(T_map_before_last.linear()), last(T_map_last.linear());
  const Eigen::Quaterniond turn = before.conjugate() * last;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (before * turn * turn).normalized().toRotationMatrix();
  T.translation() = 2 * T_map_last.translation() - T_map_before_last.translation();
  return T;
}

Eigen::Isometry3d motion_at_start(const ScanSource& source, std::size_t first, std::size_t last) {
  constexpr double surfel_m = 1;
  PoseSearchOptions around_rest;
  around_rest.radius_m = 4;   // 40 m/s at 10 Hz, 20 m/s at 5 Hz
  around_rest.step_m = 0.5;
  around_rest.yaw_rad = 0.1;
  const Eigen::Isometry3d rest = Eigen::Isometry3d::Identity();
  if (last - first < 2) return rest;

  ScanReducer reducer(surfel_m);
  SurfelMap map(SurfelMapOptions{.voxel_m = surfel_m});
  JointRegistration registration;
  const std::array targets = {JointTarget{&map, 0.02, 1.0, rest}};
  map.insert(reducer.reduce(source.read(first).points), rest);
  const SurfelCloud second = reducer.reduce(source.read(first + 1).points);
  constexpr double least_gain = 0.2;   // surfels: motions of 0.3 m gain 2.6 and more, noise 0.01
  const ScoredResult best = registration.search(second, targets, rest, around_rest, rest).front();
  const Eigen::Isometry3d T_first_second = best.score > least_gain ? best.match.T_map_scan : rest;
  if (last - first < 3) return T_first_second;
  map.insert(second, T_first_second);
  const SurfelCloud third = reducer.reduce(source.read(first + 2).points);
  const PosePrior steady{T_first_second * T_first_second, (Vector6d() << Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(100)).finished().asDiagonal()};   // to 0.1 m
  return T_first_second.inverse() * registration.align(third, targets, steady.T_map_scan, steady).T_map_scan;
}

double period_at_start(const ScanSource& source, std::size_t first, std::size_t last) {
  constexpr double usual_s = 0.1;
  const double period_s = last - first < 2 ? 0 : source.stamp_s(first + 1) - source.stamp_s(first);
  return period_s > 0 ? period_s : usual_s;
}

}  // namespace priormap
