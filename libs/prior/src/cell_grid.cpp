#include <priormap/prior/cell_grid.hpp>

#include "lattice.hpp"

namespace priormap {
namespace {

constexpr std::int64_t greatest_edge = 50'000;   // lattice steps; fits 16 bits

}  // namespace

CellGrid::CellGrid(double tile_size) {
  const std::int64_t steps = LatticeGrid(tile_size).tile_steps();
  count_ = int((steps + greatest_edge - 1) / greatest_edge);
  edge_ = (steps + count_ - 1) / count_;
}

int CellGrid::number_in_tile(TileKey cell) const {
  const TileKey tile = tile_of(cell);
  return count_ * (cell.x - tile.x * count_) + cell.y - tile.y * count_;
}

}  // namespace priormap
