#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>
#include <thread>

#include <priormap/core/error.hpp>
#include <priormap/mapping/prior_window.hpp>
#include <priormap/registration/surfel_map.hpp>
#include <priormap/registration/voxel_hash_map.hpp>

#include "town.hpp"

namespace priormap {
namespace {

std::vector<Eigen::Vector3d> plain(double length_m) {
  std::vector<Eigen::Vector3d> points;
  for (double x = 0.5; x < length_m; x += 1)
    for (double y = -20; y < 20; y += 1) points.push_back({x, y, 0});
  return points;
}

TEST(PriorWindow, EverythingWithinTheRadiusIsThereWhereverOneComesFrom) {
  const test::TiledPoints tiles(plain(2000), 50);
  PriorWindow<VoxelHashMap> prior(NearTiles(tiles, MapFrame::local(), 100), VoxelHashMap());
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

TEST(PriorWindow, MemoryDoesNotGrowWithTheDrive) {
  const test::TiledPoints tiles(plain(5000), 50);
  PriorWindow<VoxelHashMap> prior(NearTiles(tiles, MapFrame::local(), 100), VoxelHashMap());
  std::size_t most = 0;
  for (double x = 0; x < 5000; x += 20) {
    most = std::max(most, prior.around({x, 0, 0}).size());
    EXPECT_LE(prior.tiles_held(), 12u);
  }
  EXPECT_LT(most, 40u * 800u);
}

/// Takes a while to load a tile, now more, now less, or cannot at all.
class SlowPoints : public test::TiledPoints {
 public:
  using TiledPoints::TiledPoints;
  PatchCloud patches(TileKey key) const override {
    if (broken && *broken == key) throw IoError("tile is broken");
    std::this_thread::sleep_for(std::chrono::microseconds(std::random_device()() % 3000));
    return TiledPoints::patches(key);
  }
  std::optional<TileKey> broken;
};

TEST(PriorWindow, HoldsTheSameWhateverTheTiming) {
  const SlowPoints tiles(plain(1000), 50);
  std::vector<Eigen::Vector3f> first;
  for (const int threads : {1, 2, 3}) {
    PriorWindow<SurfelMap> prior(NearTiles(tiles, MapFrame::local(), 100, threads), SurfelMap());
    std::vector<Eigen::Vector3f> seen;
    for (double x = 0; x < 700; x += 7 + 3 * std::sin(x)) {
      const auto held = prior.around({x, 0, 0}).points().xyz;
      seen.insert(seen.end(), held.begin(), held.end());
    }
    if (first.empty()) first = seen;
    EXPECT_TRUE(seen == first) << threads;
  }
}

TEST(PriorWindow, ATileThatCannotBeReadIsAnErrorWhenItIsNeeded) {
  SlowPoints tiles(plain(1000), 50);
  tiles.broken = TileKey{10, 0};   // from 500 m on
  PriorWindow<SurfelMap> prior(NearTiles(tiles, MapFrame::local(), 100), SurfelMap());
  for (double x = 0; x < 399; x += 1) EXPECT_NO_THROW(prior.around({x, 0, 0}));
  EXPECT_THROW(prior.around({402, 0, 0}), IoError);
}

/// One tile of a projected CRS.
class GeoTile : public PriorPoints {
 public:
  GeoTile(const std::string& crs, const Eigen::Vector3d& corner) : crs_(Crs::parse(crs)), grid_(50) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> part(0, 50);
    tile_.origin = corner;
    for (int i = 0; i < 2000; ++i) {
      tile_.xyz.push_back({part(random), part(random), 0.2f * part(random)});
      tile_.normal.push_back(Eigen::Vector3f(0.6f, 0, 0.8f));
    }
  }
  const std::optional<Crs>& crs() const override { return crs_; }
  const TileGrid& grid() const override { return grid_; }
  std::vector<TileKey> tiles_within(const Bounds2&) const override { return {}; }
  PointCloud load(TileKey) const override { return tile_; }
  const PriorIdentity& identity() const override { return identity_; }

 private:
  std::optional<Crs> crs_;
  TileGrid grid_;
  PointCloud tile_;
  PriorIdentity identity_;
};

TEST(TileInMap, LiesWherePROJPutsItsPoints) {
  const std::vector<std::pair<std::string, Eigen::Vector3d>> places = {
      {"EPSG:25832+7837", {691'000, 5'336'000, 500}}, {"EPSG:32601", {250'000, 8'600'000, 10}},   {"EPSG:3857", {1'290'000, 6'130'000, 500}},
      {"EPSG:2056+5728", {2'683'000, 1'248'000, 400}}, {"EPSG:3035", {4'400'000, 2'790'000, 500}}, {"EPSG:2263", {987'000, 200'000, 30}}};
  for (const auto& [crs, corner] : places) {
    const GeoTile prior(crs, corner);
    const MapFrame frame = MapFrame::at(*prior.crs(), corner + Eigen::Vector3d(-2000, 1500, 0));
    const PointCloud points = tile_in_map(prior.load({}), prior, frame);
    const PatchCloud patches = tile_in_map(prior.patches({}), prior, frame);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), mean_of_patches = Eigen::Vector3d::Zero();
    double count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d exact = frame.to_map(prior.load({}).position(i));
      ASSERT_LT((points.position(i) - exact).norm(), 1e-4) << crs;
      mean += exact / double(points.size());
    }
    for (const SurfacePatch& patch : patches.patches) {
      mean_of_patches += double(patch.count) * (patches.origin + patch.mean.cast<double>());
      count += double(patch.count);
    }
    EXPECT_EQ(count, double(points.size())) << crs;
    EXPECT_LT((mean_of_patches / count - mean).norm(), 1e-3) << crs;
  }
}

TEST(TileInMap, TurnsNormalsWithTheSurfaceTheyStandOn) {
  const Eigen::Vector3d corner(500'000, 5'000'000, 0);
  const GeoTile prior("EPSG:25832", corner);
  const MapFrame frame = MapFrame::at(*prior.crs(), corner + Eigen::Vector3d(-200'000, 0, 0));   // 2 degrees away: the grids are turned
  const PointCloud tile = tile_in_map(prior.load({}), prior, frame);
  // Two directions that lie in the surface, as PROJ sees them.
  const Eigen::Vector3d p = frame.to_map(corner), north = frame.to_map(corner + Eigen::Vector3d(0, 40, 0)) - p,
                        down = frame.to_map(corner + Eigen::Vector3d(40, 0, -30)) - p;
  EXPECT_GT(std::abs(north.normalized().x()), 0.01);
  for (const Eigen::Vector3f& n : tile.normal) {
    ASSERT_NEAR(n.cast<double>().dot(north.normalized()), 0, 1e-4);
    ASSERT_NEAR(n.cast<double>().dot(down.normalized()), 0, 2e-3);   // the grid is some 0.1 % larger than the ground
  }
}

TEST(PriorWindow, SaysHowFarAPriorIs) {
  const test::TiledPoints tiles(plain(100), 50);
  EXPECT_EQ(distance_to_prior_m(tiles, {20, 0, 0}), 0);
  EXPECT_NEAR(distance_to_prior_m(tiles, {-3000, 4050, 0}), 5000, 1e-9);
}

}  // namespace
}  // namespace priormap
