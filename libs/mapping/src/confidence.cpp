#include "confidence.hpp"

#include <Eigen/LU>

namespace priormap {

Matrix6d carried_covariance() {
  Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(0.035), Eigen::Vector3d::Constant(0.5);
  return sigmas.cwiseAbs2().asDiagonal();
}

Matrix6d unknown_gap_covariance() {
  Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(3), Eigen::Vector3d::Constant(100);
  return sigmas.cwiseAbs2().asDiagonal();
}

Matrix6d start_information(const Eigen::Isometry3d& T_map_sensor) {
  Vector6d sigmas;
  sigmas << 0.02, 0.02, 0.2, 5, 5, 1;   // in map axes
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T_map_sensor.linear().transpose();
  return turn * sigmas.cwiseAbs2().cwiseInverse().asDiagonal() * turn.transpose();
}

Matrix6d covariance_of(const Matrix6d& information) {
  constexpr double least = 1e-2;
  const Matrix6d covariance = (information + least * Matrix6d::Identity()).inverse();
  return 0.5 * (covariance + covariance.transpose());
}

void doubt_what_is_contradicted(Confidence& sure, const std::vector<bool>& located) {
  std::size_t num_located = 0, num_contradicted = 0;
  for (std::size_t k = 0; k < located.size(); ++k) {
    if (!located[k]) continue;
    ++num_located;
    if (sure.contradicted[k]) ++num_contradicted;
  }
  const bool nowhere = 2 * num_contradicted >= num_located;
  for (std::size_t k = 0; k < located.size(); ++k) {
    if (nowhere || !located[k]) sure.contradicted[k] = true;
    if (nowhere) sure.covariances[k] += unknown_gap_covariance();
  }
}

}  // namespace priormap
