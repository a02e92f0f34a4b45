#pragma once
#include <cstdint>

#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {

/// Cuts the tiles of a grid into equal cells of at most 50 CRS units, numbered over the whole grid: cell (i, j) lies in tile (floor(i / n), floor(j / n)), n cells
/// along the edge of a tile. Exact on the lattice of 0.001 units: where an edge is no whole number of these per cell, the last cell of a tile is the smaller one.
class CellGrid {
 public:
  /// @throws UsageError as LatticeGrid for a tile size that a prior cannot have
  explicit CellGrid(double tile_size);

  int cells_along_tile() const { return count_; }
  int cells_a_tile() const { return count_ * count_; }
  /// Cells as tiles of their own, for searches: bounds of the last cells of a tile may be some thousandths of a unit too large.
  TileGrid as_tiles() const { return TileGrid(double(edge_) / 1000.0); }
  TileKey tile_of(TileKey cell) const { return {tile_index(cell.x), tile_index(cell.y)}; }
  /// Position of the cell in its tile, y fastest: in the order in which tiles hold their points.
  int number_in_tile(TileKey cell) const;
  TileKey cell(TileKey tile, int number) const { return {tile.x * count_ + number / count_, tile.y * count_ + number % count_}; }
  std::int64_t edge() const { return edge_; }   ///< lattice steps
  /// Corner of a cell in lattice steps from that of its tile.
  std::int64_t corner_x(int number) const { return number / count_ * edge_; }
  std::int64_t corner_y(int number) const { return number % count_ * edge_; }

 private:
  std::int32_t tile_index(std::int32_t i) const { return i >= 0 ? i / count_ : -((count_ - 1 - i) / count_); }

  int count_;
  std::int64_t edge_;   // lattice steps
};

}  // namespace priormap
