#include "cell_set.hpp"

#include <gtest/gtest.h>

namespace priormap {
namespace {

TEST(CellSet, a_cell_counts_once_however_often_it_is_met) {
  CellSet cells;
  for (int times = 0; times < 2; ++times)
    for (int row = 0; row < 200; ++row) cells.insert(row, 10, 300);
  EXPECT_EQ(cells.size(), 200u * 300);
  EXPECT_TRUE(cells.is_complete());
}

TEST(CellSet, of_cells_scattered_far_and_wide_no_more_is_kept_than_memory_allows) {
  CellSet cells(3);
  const auto insert_everywhere = [&](int row) {
    for (int col = 0; col < 64 * 1000; col += 64) cells.insert(row, col, 1);
  };
  insert_everywhere(0);
  EXPECT_EQ(cells.size(), 3u);
  EXPECT_FALSE(cells.is_complete());
  insert_everywhere(1);
  EXPECT_EQ(cells.size(), 6u) << "near those met first all are counted";
}

TEST(CellSet, as_many_as_memory_allows_are_all_counted) {
  CellSet cells(3);
  cells.insert(5, 0, 3 * 64);
  EXPECT_EQ(cells.size(), 3u * 64);
  EXPECT_TRUE(cells.is_complete());
}

}  // namespace
}  // namespace priormap
