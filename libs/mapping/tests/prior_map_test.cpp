#include <gtest/gtest.h>

#include <priormap/mapping/prior_map.hpp>

#include "town.hpp"

namespace priormap {
namespace {

std::vector<Eigen::Vector3d> plain(double length_m) {
  std::vector<Eigen::Vector3d> points;
  for (double x = 0.5; x < length_m; x += 1)
    for (double y = -20; y < 20; y += 1) points.push_back({x, y, 0});
  return points;
}

TEST(PriorMap, EverythingWithinTheRadiusIsThereWhereverOneComesFrom) {
  const test::TiledPoints tiles(plain(2000), 50);
  PriorMap prior(tiles, MapFrame::local(), {}, 100);
  // There, back, and there again: tiles dropped behind come back whole.
  for (const double x : {0.0, 30.0, 400.0, 900.0, 420.0, 60.0, 0.0, 1500.0}) {
    const VoxelHashMap& around = prior.around({x, 0, 0});
    for (double dx = -95; dx <= 95; dx += 5)
      if (x + dx > 0 && x + dx < 2000) {
        const auto neighbor = around.nearest({std::floor(x + dx) + 0.5, 3, 0});
        ASSERT_TRUE(neighbor) << x << " " << dx;
        EXPECT_LT(neighbor->distance_m, 1e-6);
      }
  }
}

TEST(PriorMap, MemoryDoesNotGrowWithTheDrive) {
  const test::TiledPoints tiles(plain(5000), 50);
  PriorMap prior(tiles, MapFrame::local(), {}, 100);
  std::size_t most = 0;
  for (double x = 0; x < 5000; x += 20) {
    most = std::max(most, prior.around({x, 0, 0}).size());
    EXPECT_LE(prior.tiles_held(), 12u);
  }
  EXPECT_LT(most, 40u * 800u);
}

TEST(PriorMap, SaysHowFarAPriorIs) {
  const test::TiledPoints tiles(plain(100), 50);
  EXPECT_EQ(distance_to_prior_m(tiles, {20, 0, 0}), 0);
  EXPECT_NEAR(distance_to_prior_m(tiles, {-3000, 4050, 0}), 5000, 1e-9);
}

}  // namespace
}  // namespace priormap
