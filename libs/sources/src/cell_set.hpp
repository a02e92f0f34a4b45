#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>

namespace priormap {

/// Cells of a raster, each counted once however often it is inserted. A bit a cell where they are scattered, next to nothing where they fill areas.
class CellSet {
 public:
  /// Of one row, from column `col` on. @param length  cells, at least one
  void insert(int row, int col, int length);
  std::uint64_t size() const { return size_; }

 private:
  static constexpr int edge = 64;   ///< of a square of cells: a word a row
  struct Square {
    std::unique_ptr<std::array<std::uint64_t, edge>> words = std::make_unique<std::array<std::uint64_t, edge>>();   ///< none once all are in
    int num_missing = edge * edge;
  };

  void insert(Square& square, int row, std::uint64_t cells);

  std::unordered_map<std::uint64_t, Square> squares_;
  std::uint64_t size_ = 0;
};

}  // namespace priormap
