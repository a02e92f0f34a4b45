#include <gtest/gtest.h>

#include <priormap/registration/likely_places.hpp>
#include <priormap/registration/scan_reducer.hpp>

#include "street.hpp"

using namespace priormap;

namespace {

constexpr double voxel_m = 1.0;

/// Houses that stand askew, on ground that rises by a metre in ten along x.
street::World hill() {
  street::World world;
  world.origin.z() = -20;
  world.faces.push_back({{-200, -100, -20}, {400, 0, 40}, {0, 200, 0}});
  for (int i = -18; i < 18; ++i) world.add_box(10 * i + 3 * (i % 3), (i % 2 ? 1 : -1) * (9 + (i * i) % 5), 7 + (i * i) % 4, 6, 29 + i, 0.5 + 0.2 * ((i * i) % 4));
  return world;
}

SurfelCloud scan_at(const street::World& world, const Eigen::Isometry3d& T) {
  SurfelCloud scan = ScanReducer(voxel_m).reduce(street::scan(world, T, {}, 7));
  tell_normals(scan, voxel_m);
  return scan;
}

/// The place first named is the right one, near enough to be registered from; also uphill, where the centre of the search lies some metres lower.
TEST(LikelyPlaces, OfAHillAreRightWherever) {
  const street::World world = hill();
  SurfelMap map;
  map.insert(street::sample(world, 0.5, 0.1f));
  const std::array<const SurfelMap*, 1> maps = {&map};
  for (const auto& [x, yaw] : {std::pair{60.0, 2.0}, {-55.0, -1.3}, {3.0, 3.1}}) {
    Eigen::Isometry3d truth = street::pose(x, 1, 0.1 * x + 1.7, yaw);
    const auto places = likely_places(scan_at(world, truth), maps, map, street::pose(0, 0, 1.7, 0.4), 70, 10);
    ASSERT_FALSE(places.empty());
    EXPECT_LT((places.front().translation() - truth.translation()).head<2>().norm(), 1.5) << x;
    EXPECT_NEAR(places.front().translation().z(), truth.translation().z(), 1) << x;
    EXPECT_LT(street::angle(places.front(), truth), 0.04) << x;
    EXPECT_LE(places.size(), 10u);
  }
}

/// A prior of buildings alone: their roofs are level, and no ground.
TEST(LikelyPlaces, LieOnNoRoofWhereGroundIsNotKnown) {
  const street::World world = hill();
  SurfelMap buildings;
  street::World without_ground = world;
  without_ground.faces.erase(without_ground.faces.begin());
  buildings.insert(street::sample(without_ground, 0.5, 0.1f));
  const std::array<const SurfelMap*, 1> maps = {&buildings};
  const Eigen::Isometry3d truth = street::pose(0, -3.2, 1.7, 2.0);   // two metres from a house
  const auto places = likely_places(scan_at(world, truth), maps, SurfelMap(), street::pose(0, 0, 1.7, 0.4), 20, 10);
  ASSERT_FALSE(places.empty());
  EXPECT_LT((places.front().translation() - truth.translation()).norm(), 1.5);
}

TEST(LikelyPlaces, AreNoneWithoutWalls) {
  street::World plain;
  plain.add_ground(-100, -100, 100, 100);
  SurfelMap map;
  map.insert(street::sample(plain, 0.5, 0.1f));
  const std::array<const SurfelMap*, 1> maps = {&map};
  const auto T = street::pose(0, 0, 1.7, 0);
  EXPECT_TRUE(likely_places(scan_at(plain, T), maps, map, T, 20, 10).empty());
  EXPECT_TRUE(likely_places(scan_at(hill(), T), maps, map, T, 20, 10).empty());
}

}  // namespace
