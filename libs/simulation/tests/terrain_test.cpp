#include <priormap/simulation/terrain.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <priormap/raycast/ray_scene.hpp>

namespace priormap {
namespace {

TEST(Terrain, HeightIsWhereARayMeetsItsMesh) {
  const Terrain terrain({-10, -20, 30, 15}, 1.5, [](const Eigen::Vector2d& p) { return 100 + std::sin(p.x()) + 0.3 * p.y(); });
  const std::vector<TriangleMesh> meshes{terrain.mesh([](const Eigen::Vector2d&) { return true; })};
  const RayScene scene(meshes, {0, 0, 100});
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d p(-9.9 + 0.19 * i, 14 * std::sin(0.7 * i));
    const std::vector<Ray> down{{Eigen::Vector3f(static_cast<float>(p.x()), static_cast<float>(p.y()), 50), -Eigen::Vector3f::UnitZ()}};
    std::vector<RayHit> hit(1);
    scene.cast(down, 200, hit);
    ASSERT_TRUE(hit[0].hit());
    EXPECT_NEAR(150 - hit[0].range_m, terrain.height(p), 1e-4);
  }
}

TEST(Terrain, MeshHoldsTheWantedCellsOnly) {
  const Terrain terrain({0, 0, 10, 10}, 1, [](const Eigen::Vector2d&) { return 0.0; });
  const auto left = [](const Eigen::Vector2d& p) { return p.x() < 4; };
  const auto right = [](const Eigen::Vector2d& p) { return p.x() >= 4; };
  EXPECT_DOUBLE_EQ(area(terrain.mesh(left)), 40);
  EXPECT_DOUBLE_EQ(area(terrain.mesh(right)), 60);
}

TEST(Relief, FollowsASlopingRoadAndLevelsOutAwayFromIt) {
  std::vector<Eigen::Vector3d> road;
  for (double x = 0; x <= 200; x += 1) road.emplace_back(x, 0, 50 + 0.04 * x);
  const Relief relief = relief_through(road, {-100, -100, 300, 100});
  for (double x = 30; x <= 170; x += 10) EXPECT_NEAR(relief({x, 0}), 50 + 0.04 * x, 0.25);
  for (double y = -90; y <= 90; y += 30) {
    EXPECT_GT(relief({100, y}), 50);
    EXPECT_LT(relief({100, y}), 58);
  }
}

TEST(Relief, HillsStayWithinTheirAmplitude) {
  const Relief relief = rolling_relief(200, 5, 7);
  double low = 1e9, high = -1e9;
  for (double x = -1000; x < 1000; x += 17)
    for (double y = -1000; y < 1000; y += 23) {
      low = std::min(low, relief({x, y}));
      high = std::max(high, relief({x, y}));
    }
  EXPECT_GE(low, 195);
  EXPECT_LE(high, 205);
  EXPECT_GT(high - low, 1) << "there are hills";
}

}  // namespace
}  // namespace priormap
