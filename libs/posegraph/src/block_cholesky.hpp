#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "sparse_blocks.hpp"

namespace priormap {

/// W D W^T of a positive definite matrix: W unit lower triangular and D diagonal, block by block.
class BlockCholesky {
 public:
  /// None: the matrix is not positive definite.
  static std::optional<BlockCholesky> of(SparseBlocks matrix);

  /// The inverse where the factor is not zero, without the rest of it: the recursion of Takahashi et al. (1973), block by block. Linear in the size of a block-tridiagonal matrix.
  SparseBlocks inverse_on_pattern() &&;

 private:
  explicit BlockCholesky(SparseBlocks factor) : factor_(std::move(factor)) {}
  SparseBlocks factor_;   // W below the diagonal, the inverse of D on it
};

}  // namespace priormap
