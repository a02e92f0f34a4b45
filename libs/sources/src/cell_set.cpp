#include "cell_set.hpp"

#include <algorithm>
#include <bit>

namespace priormap {

void CellSet::insert(int row, int col, int length) {
  const int end = col + length;
  while (col < end) {
    const int first = col % edge, count = std::min(edge - first, end - col);
    const std::uint64_t cells = (~std::uint64_t(0) >> (edge - count)) << first;
    if (Square* square = square_at(row, col))
      insert(*square, row % edge, cells);
    else
      is_complete_ = false;
    col += count;
  }
}

CellSet::Square* CellSet::square_at(int row, int col) {
  const std::uint64_t key = std::uint64_t(row / edge) << 32 | std::uint64_t(col / edge);
  if (squares_.size() < most_squares_) return &squares_[key];
  const auto found = squares_.find(key);
  return found == squares_.end() ? nullptr : &found->second;
}

void CellSet::insert(Square& square, int row, std::uint64_t cells) {
  if (!square.words) return;
  std::uint64_t& word = (*square.words)[static_cast<std::size_t>(row)];
  const int num_new = std::popcount(cells & ~word);
  word |= cells;
  size_ += static_cast<std::uint64_t>(num_new);
  square.num_missing -= num_new;
  if (square.num_missing == 0) square.words.reset();
}

}  // namespace priormap
