#include "selected_inverse.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <priormap/core/error.hpp>

namespace priormap {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Entries of Z = (L D L^T)^-1 on the pattern of the unit lower triangular L, column by column from the last:
/// Z_ij = [i = j] / D_j - sum over k > j of Z_ik L_kj.
Sparse inverse_on_pattern(const Sparse& L, const Eigen::VectorXd& D) {
  Sparse Z = L;
  std::vector<double> l_of_row(std::size_t(L.rows()), 0.0), z_of_row(std::size_t(L.rows()), 0.0);
  std::vector<char> in_column(std::size_t(L.rows()), 0);
  for (Eigen::Index j = L.cols() - 1; j >= 0; --j) {
    for (Sparse::InnerIterator l(L, j); l; ++l) {
      if (l.row() == j) continue;
      in_column[std::size_t(l.row())] = 1;
      l_of_row[std::size_t(l.row())] = l.value();
    }
    for (Sparse::InnerIterator l(L, j); l; ++l) {
      if (l.row() == j) continue;
      const Eigen::Index k = l.row();
      for (Sparse::InnerIterator z(Z, k); z; ++z) {
        if (!in_column[std::size_t(z.row())]) continue;
        z_of_row[std::size_t(z.row())] -= l.value() * z.value();
        if (z.row() != k) z_of_row[std::size_t(k)] -= l_of_row[std::size_t(z.row())] * z.value();
      }
    }
    double diagonal = 1.0 / D[j];
    for (Sparse::InnerIterator l(L, j); l; ++l)
      if (l.row() != j) diagonal -= l.value() * z_of_row[std::size_t(l.row())];
    for (Sparse::InnerIterator z(Z, j); z; ++z) {
      const auto row = std::size_t(z.row());
      z.valueRef() = z.row() == j ? diagonal : z_of_row[row];
      in_column[row] = 0;
      l_of_row[row] = z_of_row[row] = 0.0;
    }
  }
  return Z;
}

}  // namespace

std::vector<Matrix6d> diagonal_blocks_of_inverse(const Sparse& lower) {
  const Eigen::SimplicialLDLT<Sparse, Eigen::Lower> solver(lower);
  if (solver.info() != Eigen::Success) throw Error("pose graph: its normal matrix cannot be factorised");
  const Sparse Z = inverse_on_pattern(Sparse(solver.matrixL()), solver.vectorD());
  const auto& order = solver.permutationP().indices();
  std::vector<Matrix6d> blocks(std::size_t(lower.rows() / 6));
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j) {
        const auto row = order[Eigen::Index(6 * b) + i], column = order[Eigen::Index(6 * b) + j];
        blocks[b](i, j) = blocks[b](j, i) = Z.coeff(std::max(row, column), std::min(row, column));
      }
  return blocks;
}

}  // namespace priormap
