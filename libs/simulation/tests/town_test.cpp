#include <priormap/simulation/town.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <priormap/simulation/town_generator.hpp>
#include <priormap/simulation/world.hpp>

namespace priormap {
namespace {

const Ring2 house_ring{{0, 0}, {12, 0}, {12, 8}, {0, 8}};

Terrain flat_ground(double z) {
  return Terrain({-60, -60, 60, 60}, 1, [z](const Eigen::Vector2d&) { return z; });
}

Building house(RoofShape shape, const Terrain& terrain) {
  Building building;
  building.outline.exterior = house_ring;
  building.roof_shape = shape;
  place_on_ground(building, terrain, 6, Eigen::Vector2d::UnitX(), 0.5);
  return building;
}

TEST(Roof, GableRisesFromTheEavesToTheRidge) {
  const Building gabled = house(RoofShape::gabled, flat_ground(100));
  EXPECT_DOUBLE_EQ(gabled.eaves_z, 106);
  EXPECT_NEAR(gabled.roof_height({3, 0}), 106, 1e-9);
  EXPECT_NEAR(gabled.roof_height({3, 4}), 108, 1e-9) << "half the width times the pitch above the eaves";
  EXPECT_NEAR(gabled.roof_height({0, 4}), 108, 1e-9) << "the ridge reaches the gable";
  EXPECT_NEAR(gabled.height_m(), 8, 1e-9);
}

TEST(Roof, HipSlopesToAllSides) {
  const Building hipped = house(RoofShape::hipped, flat_ground(100));
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(0, 4), Eigen::Vector2d(12, 4), Eigen::Vector2d(6, 0), Eigen::Vector2d(6, 8)})
    EXPECT_NEAR(hipped.roof_height(p), 106, 1e-9);
  EXPECT_NEAR(hipped.roof_height({6, 4}), 108, 1e-9);
  EXPECT_NEAR(hipped.height_m(), 8, 1e-9);
}

TEST(Roof, MainAxisIsTheLongSide) {
  const Eigen::Vector2d axis = main_axis({{0, 0}, {3, 4}, {-5, 10}, {-8, 6}});
  EXPECT_NEAR(std::abs(axis.dot(Eigen::Vector2d(-0.8, 0.6))), 1, 1e-9);
}

TEST(Building, WallsReachBelowTheLowestGround) {
  const Terrain slope({-60, -60, 60, 60}, 1, [](const Eigen::Vector2d& p) { return 100 + 0.1 * p.x(); });
  const Building building = house(RoofShape::flat, slope);
  EXPECT_LT(building.base_z, 100);
  EXPECT_NEAR(building.ground_z, 100.6, 0.15);
}

TEST(World, SurveySeesRoofsWhereTheTownHasThemAndNoCars) {
  Town town{flat_ground(100), {}, {house(RoofShape::gabled, flat_ground(100))}, {}, {}, {{{-20, -20, 100}, 0.3, {4.5, 1.8, 1.5}}}, {}};
  town.buildings[0].overhang_m = 0.4;
  const World world = build_world(town, 1);
  const std::vector<Eigen::Vector2d> places{{3, 1}, {9, 7.5}, {6, 8.2}, {-5, -5}, {-20, -20}, {500, 0}};
  const std::vector<float> heights = world.surface_heights(places);
  EXPECT_NEAR(heights[0], town.buildings[0].roof_height(places[0]), 1e-3);
  EXPECT_NEAR(heights[1], town.buildings[0].roof_height(places[1]), 1e-3);
  EXPECT_NEAR(heights[2], 105.9, 1e-3) << "the overhang lies below the eaves";
  EXPECT_NEAR(heights[3], 100, 1e-3);
  EXPECT_NEAR(heights[4], 100, 1e-3) << "parked cars are not surveyed";
  EXPECT_TRUE(std::isnan(heights[5]));
}

TEST(World, WallsStandOnTheOutline) {
  const Town town{flat_ground(100), {}, {house(RoofShape::gabled, flat_ground(100))}, {}, {}, {}, {}};
  const World world = build_world(town, 1);
  int walls = 0, recessed = 0;
  for (double x = 0.05; x < 12; x += 0.1) {
    const std::vector<Ray> north{{(Eigen::Vector3d(x, -10, 101.6) - world.scene.origin()).cast<float>(), Eigen::Vector3f::UnitY()}};
    std::vector<RayHit> hit(1);
    world.scene.cast(north, 100, hit);
    ASSERT_TRUE(hit[0].hit());
    if (world.parts[hit[0].mesh].material == Material::wall) {
      EXPECT_NEAR(hit[0].range_m, 10, 1e-3);
      ++walls;
    } else {
      EXPECT_EQ(world.parts[hit[0].mesh].material, Material::glass);
      EXPECT_GT(hit[0].range_m, 10.05);
      EXPECT_LT(hit[0].range_m, 10.3);
      ++recessed;
    }
  }
  EXPECT_GT(walls, 30);
  EXPECT_GT(recessed, 5);
}

TEST(GeneratedTown, NothingStandsOnTheStreetOrInABuilding) {
  TownPlan plan;
  plan.streets = {{"Street 1", {{-150, 0}, {0, 10}, {150, 0}}, 4}, {"Street 2", {{0, 10}, {20, 150}}, 4}};
  plan.driven = {{-150, 0}, {0, 10}, {20, 150}};
  plan.relief = [](const Eigen::Vector2d& p) { return 200 + 0.02 * p.x(); };
  plan.bounds = {-240, -90, 240, 240};
  const Town town = generate_town(plan, {}, 3);
  EXPECT_GT(town.buildings.size(), 25u);
  EXPECT_GT(town.parked_cars.size(), 5u);
  EXPECT_GT(town.trees.size(), 5u);
  const auto to_line = [](const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm();
  };
  const auto to_streets = [&](const Eigen::Vector2d& p) {
    double nearest = 1e9;
    for (const Street& street : plan.streets)
      for (std::size_t i = 0; i + 1 < street.line.size(); ++i) nearest = std::min(nearest, to_line(p, street.line[i], street.line[i + 1]));
    return nearest;
  };
  for (const Building& building : town.buildings) {
    for_each_edge(building.outline.exterior, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      for (double u = 0; u < 1; u += 0.05) EXPECT_GT(to_streets(a + u * (b - a)), 4 + 1.0) << building.id;
    });
    for (const Building& other : town.buildings) {
      if (&other == &building) continue;
      Eigen::Vector2d centre = Eigen::Vector2d::Zero();
      for (const Eigen::Vector2d& p : other.outline.exterior) centre += p / static_cast<double>(other.outline.exterior.size());
      EXPECT_FALSE(contains(building.outline, centre)) << building.id << " covers " << other.id;
    }
    for (const Tree& tree : town.trees) EXPECT_FALSE(contains(building.outline, tree.foot.head<2>()));
  }
  for (const Car& car : town.parked_cars) EXPECT_GT(to_streets(car.position.head<2>()), 2.0) << "the lane stays free";
  for (const Pole& pole : town.poles) EXPECT_GT(to_streets(pole.foot.head<2>()), 4.0);
}

}  // namespace
}  // namespace priormap
