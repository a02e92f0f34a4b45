#include <priormap/simulation/traffic.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace priormap {
namespace {

std::vector<TrackPoint> straight_drive() {
  std::vector<TrackPoint> track;
  for (int i = 0; i < 600; ++i) track.push_back({0.1 * i, {0.8 * i, 0}, 0});
  return track;
}

const Terrain ground({-50, -50, 600, 50}, 1, [](const Eigen::Vector2d& p) { return 0.01 * p.x(); });

TEST(Traffic, KeepsClearOfTheVehicleAndStandsOnTheGround) {
  const auto track = straight_drive();
  const Traffic traffic(track, 50, 1);
  std::size_t most = 0;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const auto cars = traffic.at(i, ground);
    most = std::max(most, cars.size());
    for (const Car& car : cars) {
      const Eigen::Vector2d offset = car.position.head<2>() - track[i].position;
      EXPECT_LT(offset.norm(), 121);
      EXPECT_TRUE(std::abs(offset.x()) > 10 || std::abs(offset.y()) > 2.2);
      EXPECT_NEAR(car.position.z(), 0.01 * car.position.x(), 1e-9);
    }
  }
  EXPECT_GT(most, 4u);
  EXPECT_TRUE(Traffic(track, 0, 1).at(10, ground).empty());
}

TEST(Traffic, CarsMoveSteadily) {
  const auto track = straight_drive();
  const Traffic traffic(track, 50, 1);
  for (std::size_t i = 200; i < 210; ++i)
    for (const Car& car : traffic.at(i, ground)) {
      const bool oncoming = std::abs(car.yaw) > 1;
      const double expected_x = car.position.x() + (oncoming ? -0.8 : 0.8);
      if (std::abs(expected_x - track[i + 1].position.x()) > 119) continue;
      bool found = false;
      for (const Car& later : traffic.at(i + 1, ground)) found |= std::abs(later.position.x() - expected_x) < 1e-6 && later.size_m == car.size_m;
      EXPECT_TRUE(found);
    }
}

}  // namespace
}  // namespace priormap
