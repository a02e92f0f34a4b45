#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>

namespace priormap {

/// Cells of a raster, each counted once however often it is inserted. A bit a cell where they are scattered, next to nothing where they fill areas. Memory is bounded: where cells lie in more
/// squares of 64 by 64 than `most_squares`, those in further ones are not counted.
class CellSet {
 public:
  /// By default 60 MB at most.
  explicit CellSet(std::size_t most_squares = 100'000) : most_squares_(most_squares) {}
  /// Of one row, from column `col` on. @param length  cells, at least one
  void insert(int row, int col, int length);
  std::uint64_t size() const { return size_; }
  bool is_complete() const { return is_complete_; }   ///< else there are more than `size`

 private:
  static constexpr int edge = 64;   ///< of a square of cells: a word a row
  struct Square {
    std::unique_ptr<std::array<std::uint64_t, edge>> words = std::make_unique<std::array<std::uint64_t, edge>>();   ///< none once all are in
    int num_missing = edge * edge;
  };

  Square* square_at(int row, int col);
  void insert(Square& square, int row, std::uint64_t cells);

  std::size_t most_squares_;
  std::unordered_map<std::uint64_t, Square> squares_;
  std::uint64_t size_ = 0;
  bool is_complete_ = true;
};

}  // namespace priormap
