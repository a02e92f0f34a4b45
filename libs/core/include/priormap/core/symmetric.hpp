#pragma once
#include <Eigen/Core>

namespace priormap {

/// A symmetric 3x3 matrix as its upper triangle: xx, xy, xz, yy, yz, zz.
template <class Scalar>
using SymmetricRow = Eigen::Matrix<Scalar, 6, 1>;

template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> full_of(const SymmetricRow<Scalar>& c) {
  Eigen::Matrix<Scalar, 3, 3> full;
  full << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  return full;
}

template <class Scalar>
SymmetricRow<Scalar> row_of(const Eigen::Matrix<Scalar, 3, 3>& full) {
  return (SymmetricRow<Scalar>() << full(0, 0), full(0, 1), full(0, 2), full(1, 1), full(1, 2), full(2, 2)).finished();
}

/// A c A^T: a covariance in other axes.
template <class Scalar>
SymmetricRow<Scalar> turned(const SymmetricRow<Scalar>& c, const Eigen::Matrix<Scalar, 3, 3>& A) {
  return row_of<Scalar>(A * full_of(c) * A.transpose());
}

}  // namespace priormap
