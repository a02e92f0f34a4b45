#include "sweep_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include <priormap/core/symmetric.hpp>

namespace priormap {
namespace {

/// exp(t velocity) by its series up to t^3: a turn of 0.15 rad within half a sweep leaves 2e-5 of the range.
class Sweep {
 public:
  explicit Sweep(const Vector6d& velocity) {
    const Eigen::Matrix3d W = hat(velocity.head<3>());
    const Eigen::Vector3d v = velocity.tail<3>();
    turn_[0] = W.cast<float>();
    turn_[1] = (W * W / 2).cast<float>();
    turn_[2] = (W * W * W / 6).cast<float>();
    way_[0] = v.cast<float>();
    way_[1] = (W * v / 2).cast<float>();
    way_[2] = (W * W * v / 6).cast<float>();
  }
  Eigen::Vector3f shift(const Eigen::Vector3f& p, float t) const {
    return t * (turn_[0] * p + way_[0] + t * (turn_[1] * p + way_[1] + t * (turn_[2] * p + way_[2])));
  }
  Eigen::Matrix3f turn(float t) const { return Eigen::Matrix3f::Identity() + t * (turn_[0] + t * turn_[1]); }

 private:
  Eigen::Matrix3f turn_[3];
  Eigen::Vector3f way_[3];
};

}  // namespace

Vector6d steady_velocity(const Eigen::Isometry3d& T_from, const Eigen::Isometry3d& T_to, double duration_s) {
  const Vector6d between = local_coordinates(T_from, T_to);
  Vector6d velocity;
  velocity.head<3>() = between.head<3>() / duration_s;
  velocity.tail<3>() = inverse_right_jacobian_so3(-between.head<3>()) * between.tail<3>() / duration_s;   // the left one
  return velocity;
}

Eigen::Isometry3d moved_on(const Eigen::Isometry3d& T, const Vector6d& velocity, double duration_s) {
  const Eigen::Vector3d w = duration_s * velocity.head<3>(), v = duration_s * velocity.tail<3>();
  Vector6d step;
  step.head<3>() = w;
  step.tail<3>() = inverse_right_jacobian_so3(-w).inverse() * v;
  return retract(T, step);
}

void undo_motion(PointCloud& scan, const Vector6d& velocity) {
  if (scan.time_s.size() != scan.size()) return;
  const Sweep sweep(velocity);
  for (std::size_t i = 0; i < scan.size(); ++i) scan.xyz[i] += sweep.shift(scan.xyz[i], scan.time_s[i]);
}

void undo_motion(SurfelCloud& scan, const Vector6d& velocity) {
  const Sweep sweep(velocity);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    Surfel& surfel = scan.surfels[i];
    if (surfel.time_s == 0) continue;
    surfel.mean += sweep.shift(surfel.mean, surfel.time_s);
    surfel.covariance = turned(surfel.covariance, sweep.turn(surfel.time_s));
    if (!scan.around.empty()) scan.around[i].normal = sweep.turn(surfel.time_s) * scan.around[i].normal;
  }
}

double mean_time_s(const SurfelCloud& scan) {
  double sum = 0;
  for (const Surfel& surfel : scan.surfels) sum += static_cast<double>(surfel.time_s);
  return scan.empty() ? 0 : sum / static_cast<double>(scan.size());
}

void count_times_from(SurfelCloud& scan, double time_s) {
  if (time_s == 0) return;
  for (Surfel& surfel : scan.surfels) surfel.time_s -= static_cast<float>(time_s);
}

void move(SurfelCloud& scan, const Eigen::Isometry3d& T_target_scan) {
  const Eigen::Matrix3f R = T_target_scan.linear().cast<float>();
  const Eigen::Vector3f t = T_target_scan.translation().cast<float>();
  for (Surfel& surfel : scan.surfels) {
    surfel.mean = R * surfel.mean + t;
    surfel.covariance = turned(surfel.covariance, R);
  }
  for (SurfelShape& shape : scan.around) shape.normal = R * shape.normal;
}

double longest_time_s(const SurfelCloud& scan) {
  float longest = 0;
  for (const Surfel& surfel : scan.surfels) longest = std::max(longest, std::abs(surfel.time_s));
  return static_cast<double>(longest);
}

}  // namespace priormap
