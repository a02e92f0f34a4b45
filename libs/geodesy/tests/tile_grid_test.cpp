#include <priormap/geodesy/tile_grid.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using priormap::Bounds2;
using priormap::TileGrid;
using priormap::TileKey;

TEST(TileGridTest, EdgesBelongToTheUpperTile) {
  const TileGrid grid(200);
  EXPECT_EQ(grid.key(400, -200), (TileKey{2, -1}));
  EXPECT_EQ(grid.key(std::nextafter(400, 0), std::nextafter(-200, -300)), (TileKey{1, -2}));
  EXPECT_EQ(grid.key(0, -0.0), (TileKey{0, 0}));
  EXPECT_EQ(TileGrid::name({-3, 26680}), "-3_26680");
}

// Sizes without exact binary form must not open gaps or overlaps between tiles.
TEST(TileGridTest, EveryPointLiesInTheBoundsOfItsTileAndNoOther) {
  std::mt19937_64 random(1);
  for (const double size : {0.1, 0.3, 7.7, 200.0, 333.3}) {
    const TileGrid grid(size);
    std::uniform_int_distribution<int> index(-1000000, 1000000);
    for (int n = 0; n < 2000; ++n) {
      const double edge = index(random) * size;
      for (const double x : {edge, std::nextafter(edge, -1e9), std::nextafter(edge, 1e9)}) {
        const TileKey key = grid.key(x, x);
        EXPECT_TRUE(grid.bounds(key).contains(x, x));
        EXPECT_FALSE(grid.bounds({key.x + 1, key.y}).contains(x, x));
        EXPECT_FALSE(grid.bounds({key.x - 1, key.y}).contains(x, x));
      }
    }
  }
}

TEST(TileGridTest, BoundsAreEmptyWithoutExtent) {
  EXPECT_TRUE((Bounds2{1, 1, 1, 2}.empty()));
  EXPECT_TRUE((Bounds2{1, 1, std::nan(""), 2}.empty()));
  EXPECT_FALSE((Bounds2{0, 0, 1, 1}.empty()));
}
