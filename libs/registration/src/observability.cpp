#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <priormap/registration/observability.hpp>

namespace priormap {
namespace {

struct Principal {
  Eigen::Vector3d sigma;
  Eigen::Matrix3d axes;
};

/// Information of `kept` after the `other` block has been marginalised out: the Schur complement.
Principal principal_of(const Eigen::Matrix3d& kept, const Eigen::Matrix3d& cross, const Eigen::Matrix3d& other) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of_other(other);
  const double floor = 1e-12 * std::max(of_other.eigenvalues()[2], 1e-300);
  const Eigen::Vector3d inverse = (of_other.eigenvalues().array() > floor).select(of_other.eigenvalues().cwiseInverse(), 0.0);
  const Eigen::Matrix3d other_inverse = of_other.eigenvectors() * inverse.asDiagonal() * of_other.eigenvectors().transpose();
  const Eigen::Matrix3d marginal = kept - cross * other_inverse * cross.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (marginal + marginal.transpose()));
  const double least = 1e-12 * std::max(kept.trace(), 1e-300);  // below this it is rounding
  Principal out;
  for (int i = 0; i < 3; ++i) {
    const double value = solver.eigenvalues()[i];
    out.sigma[i] = value > least ? 1.0 / std::sqrt(value) : std::numeric_limits<double>::infinity();
  }
  out.axes = solver.eigenvectors();
  return out;
}

}  // namespace

Observability observability(const Matrix6d& information) {
  const Eigen::Matrix3d rotation = information.topLeftCorner<3, 3>(), translation = information.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d cross = information.topRightCorner<3, 3>();
  const Principal t = principal_of(translation, cross.transpose(), rotation);
  const Principal r = principal_of(rotation, cross, translation);
  return {t.sigma, t.axes, r.sigma, r.axes};
}

}  // namespace priormap
