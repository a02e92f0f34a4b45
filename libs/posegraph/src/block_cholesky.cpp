#include "block_cholesky.hpp"

#include <Eigen/Cholesky>
#include <cstdint>

namespace priormap {
namespace {

using Column = SparseBlocks::Column;

/// Calls `visit(n, block)` for the n-th of `rows`, from `first` on, with the block of `column` in that row. The column has them all.
template <class Blocks, class Visit>
void for_rows(const std::vector<std::uint32_t>& rows, std::size_t first, const std::vector<std::uint32_t>& column_rows, Blocks& blocks, const Visit& visit) {
  for (std::size_t n = first, at = 0; n < rows.size(); ++n) {
    while (column_rows[at] != rows[n]) ++at;
    visit(n, blocks[at]);
  }
}

}  // namespace

std::optional<BlockCholesky> BlockCholesky::of(SparseBlocks matrix) {
  std::vector<Matrix6d> before;
  for (Column& column : matrix.columns()) {
    const Eigen::LLT<Matrix6d> pivot(column.diagonal);
    if (pivot.info() != Eigen::Success) return std::nullopt;
    column.diagonal = pivot.solve(Matrix6d::Identity());
    before = column.blocks;
    for (Matrix6d& block : column.blocks) block = block * column.diagonal;
    for (std::size_t n = 0; n < column.rows.size(); ++n) {
      Column& later = matrix.columns()[column.rows[n]];
      const Matrix6d W_t = column.blocks[n].transpose();
      later.diagonal.noalias() -= before[n] * W_t;
      for_rows(column.rows, n + 1, later.rows, later.blocks, [&](std::size_t m, Matrix6d& block) { block.noalias() -= before[m] * W_t; });
    }
  }
  return BlockCholesky(std::move(matrix));
}

/// Column by column from the last: Z_ij = [i = j] D_j^-1 - sum over k > j of Z_ik W_kj.
SparseBlocks BlockCholesky::inverse_on_pattern() && {
  std::vector<Column>& columns = factor_.columns();
  std::vector<Matrix6d> Z;
  for (std::size_t c = columns.size(); c-- > 0;) {
    Column& column = columns[c];
    Z.assign(column.rows.size(), Matrix6d::Zero());
    for (std::size_t n = 0; n < column.rows.size(); ++n) {
      const Column& later = columns[column.rows[n]];
      const Matrix6d& W = column.blocks[n];
      Z[n].noalias() -= later.diagonal * W;
      for_rows(column.rows, n + 1, later.rows, later.blocks, [&](std::size_t m, const Matrix6d& block) {
        Z[m].noalias() -= block * W;
        Z[n].noalias() -= block.transpose() * column.blocks[m];
      });
    }
    for (std::size_t n = 0; n < column.rows.size(); ++n) column.diagonal.noalias() -= column.blocks[n].transpose() * Z[n];
    column.diagonal = (0.5 * (column.diagonal + column.diagonal.transpose())).eval();
    column.blocks.swap(Z);
  }
  return std::move(factor_);
}

}  // namespace priormap
