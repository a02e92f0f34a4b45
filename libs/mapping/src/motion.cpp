#include <priormap/mapping/motion.hpp>

namespace priormap {

Eigen::Isometry3d predict(const Eigen::Isometry3d& T_map_before_last, const Eigen::Isometry3d& T_map_last) {
  const Eigen::Quaterniond before(T_map_before_last.linear()), last(T_map_last.linear());
  const Eigen::Quaterniond turn = before.conjugate() * last;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (before * turn * turn).normalized().toRotationMatrix();
  T.translation() = 2 * T_map_last.translation() - T_map_before_last.translation();
  return T;
}

}  // namespace priormap
