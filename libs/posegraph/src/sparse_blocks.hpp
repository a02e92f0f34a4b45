#pragma once
#include <cstddef>
#include <cstdint>
#include <priormap/core/se3.hpp>
#include <vector>

namespace priormap {

/// A symmetric matrix of 6x6 blocks of which most are zero. Its rows keep a second order, `rank`, in which elimination fills in few blocks more (approximate minimum degree:
/// Amestoy, Davis, Duff 1996); those have their place from the beginning.
class SparseBlocks {
 public:
  /// Blocks below the diagonal of one column, by rank.
  struct Column {
    Matrix6d diagonal = Matrix6d::Zero();
    std::vector<std::uint32_t> rows;   ///< ascending
    std::vector<Matrix6d> blocks;
  };

  /// All zero. @param neighbours  of each row: the columns where its blocks may become other than zero; each pair in one of its two rows at least
  explicit SparseBlocks(std::vector<std::vector<std::uint32_t>> neighbours);

  std::size_t size() const { return columns_.size(); }
  /// Adds to the blocks (i, j) and, transposed, (j, i).
  void add(std::size_t i, std::size_t j, const Matrix6d& block);
  Matrix6d at(std::size_t i, std::size_t j) const;

  /// By rank.
  std::vector<Column>& columns() { return columns_; }
  const std::vector<Column>& columns() const { return columns_; }

 private:
  std::vector<std::uint32_t> rank_;
  std::vector<Column> columns_;
};

}  // namespace priormap
