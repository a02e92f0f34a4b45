#pragma once
#include <Eigen/SparseCore>
#include <priormap/core/se3.hpp>
#include <vector>

namespace priormap {

/// The 6x6 diagonal blocks of the inverse of a sparse symmetric positive definite matrix of 6x6 blocks (lower triangle given), without the rest of the inverse:
/// the recursion of Takahashi et al. (1973) over the pattern of its Cholesky factor. Linear in the size of a block-tridiagonal matrix.
std::vector<Matrix6d> diagonal_blocks_of_inverse(const Eigen::SparseMatrix<double>& lower);

}  // namespace priormap
