#include "prior_tracker.hpp"

#include <gtest/gtest.h>

#include "town.hpp"

namespace priormap {
namespace {

/// The covariance of points that spread over most of a voxel along two axes, or along one.
Eigen::Matrix<float, 6, 1> spread(const Eigen::Vector3f& sigmas_m) {
  const Eigen::Vector3f variances = sigmas_m.cwiseAbs2();
  return (Eigen::Matrix<float, 6, 1>() << variances.x(), 0, 0, variances.y(), 0, variances.z()).finished();
}

constexpr float wide_m = 0.28f, narrow_m = 0.01f;

/// Surfels of a scan and points of a prior, of planes along the axes.
struct Scene {
  SurfelCloud scan;
  PointCloud prior;

  void see(const Eigen::Vector3f& p_sensor, const Eigen::Vector3f& normal) {
    scan.surfels.push_back({.mean = p_sensor, .count = 20, .covariance = spread(Eigen::Vector3f::Constant(wide_m) + (narrow_m - wide_m) * normal)});
  }
  /// A trace of one laser on a wall along x; those around it tell that it is one.
  void see_trace(const Eigen::Vector3f& p_sensor) {
    scan.few_lasers = true;
    scan.surfels.push_back({.mean = p_sensor, .count = 20, .covariance = spread({wide_m, narrow_m, narrow_m})});
    scan.around.resize(scan.size());
    scan.around.back() = {.normal = Eigen::Vector3f::UnitY(), .directed = 1};
  }
  void know(const Eigen::Vector3f& p_map, const Eigen::Vector3f& normal) {
    prior.xyz.push_back(p_map);
    prior.normal.push_back(normal);
  }
};

/// The prior knows no wall: its traces, half a metre above the ground, lie nearest to that, and are many.
TEST(PriorTracker, WallsThatThePriorDoesNotKnowLeaveTheGroundWhereItIs) {
  constexpr float sensor_z = 1.5f;
  Scene scene;
  for (int x = -10; x < 10; ++x)
    for (int y = -3; y < 3; ++y) {
      const Eigen::Vector3f p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0);
      scene.know(p, Eigen::Vector3f::UnitZ());
      const bool street = std::abs(y) < 2;
      if (street && x % 4 == 0) scene.see(p - Eigen::Vector3f(0, 0, sensor_z), Eigen::Vector3f::UnitZ());
      if (!street) scene.see_trace(p - Eigen::Vector3f(0, 0, sensor_z - 0.6f));
    }
  scene.scan.around.resize(scene.scan.size());
  const test::TiledPoints tiles(scene.prior, 50);
  TrackingOptions options;
  options.start_keyframes = 0;
  PriorTracker tracker(options, 1.0, NearTiles(tiles, MapFrame::local(), 150), test::pose(0, 0, sensor_z + 0.1, 0));
  const auto match = tracker.follow(scene.scan, Eigen::Isometry3d::Identity());
  ASSERT_TRUE(match && match->figures.accepted);
  EXPECT_NEAR(tracker.T_map_odom().translation().z(), sensor_z, 0.02);
}

/// Walls along a street, those of the scan by so much off those of the prior, piece by piece. @return whether the start is believed after one scan
bool is_believed(const std::vector<float>& offsets_m) {
  constexpr float sensor_z = 1.5f;
  Scene scene;
  for (int x = -20; x < 20; ++x)
    for (const float side : {-1.0f, 1.0f})
      for (const float z : {0.5f, 1.5f, 2.5f, 3.5f}) {
        const Eigen::Vector3f p(static_cast<float>(x) + 0.5f, 5.5f * side, z);
        scene.know(p, Eigen::Vector3f::UnitY());
        scene.see(p + Eigen::Vector3f(0, side * offsets_m[static_cast<std::size_t>(x + 20) / 2 % offsets_m.size()], -sensor_z), Eigen::Vector3f::UnitY());
      }
  const test::TiledPoints tiles(scene.prior, 50);
  TrackingOptions options;
  options.search.radius_m = options.search.yaw_rad = 0;   // else it is moved away to where nothing is known
  PriorTracker tracker(options, 1.0, NearTiles(tiles, MapFrame::local(), 150), test::pose(0, 0, sensor_z, 0));
  tracker.follow(scene.scan, Eigen::Isometry3d::Identity());
  return tracker.is_located();
}

/// However short the recording: a start that walls contradict is not to be called anchored, wherever it is.
TEST(PriorTracker, AStartThatWallsContradictIsNotBelieved) {
  EXPECT_TRUE(is_believed({0}));
  EXPECT_TRUE(is_believed({0.3f, -0.3f, 0.2f, -0.1f}));
  EXPECT_FALSE(is_believed({-1.3f, -0.8f, 0.9f, 1.4f}));
}

/// A street along x, of which the first scan sees a pier that the prior has not; it has another one 1.3 m on. The scans after it see one that both know. By the word of a start that may be metres off
/// the first scan slides to the wrong one; where the start is taken at its word, it stays.
TEST(PriorTracker, WhereTheFirstScanSlidesToWhatIsNotThereThePlaceNearTheStartIsCompared) {
  constexpr float sensor_z = 1.5f, step_m = 3, of_both_x = 25.5f, of_scan_x = 10.5f, of_prior_x = of_scan_x + 1.3f;
  constexpr int num_scans = 5;
  Scene scene;
  std::vector<SurfelCloud> scans;
  const auto pier = [](float x, auto&& take) {
    for (const float y : {-3.5f, -2.5f, 2.5f, 3.5f})
      for (const float z : {0.5f, 1.5f, 2.5f}) take(Eigen::Vector3f(x, y, z), Eigen::Vector3f::UnitX());
  };
  const auto street = [](float first_x, float last_x, auto&& take) {
    for (float x = first_x + 0.5f; x < last_x; x += 1) {
      for (const float y : {-1.5f, -0.5f, 0.5f, 1.5f}) take(Eigen::Vector3f(x, y, 0), Eigen::Vector3f::UnitZ());
      for (const float y : {-5.5f, 5.5f}) take(Eigen::Vector3f(x, y, 1.5f), Eigen::Vector3f::UnitY());
    }
  };
  const auto know = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& normal) { scene.know(p, normal); };
  street(-40, 60, know);
  pier(of_prior_x, know);
  pier(of_both_x, know);
  for (int k = 0; k < num_scans; ++k) {
    const float x = step_m * static_cast<float>(k);
    const auto see = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& normal) { scene.see(p - Eigen::Vector3f(x, 0, sensor_z), normal); };
    scene.scan = {};
    street(x - 12, x + 12, see);
    pier(k == 0 ? of_scan_x : of_both_x, see);
    scans.push_back(scene.scan);
  }
  const test::TiledPoints tiles(scene.prior, 50);
  TrackingOptions options;
  options.start_keyframes = num_scans;
  options.search.radius_m = 0;   // no other place is looked for
  PriorTracker tracker(options, 1.0, NearTiles(tiles, MapFrame::local(), 150), test::pose(0, 0, sensor_z, 0));
  for (int k = 0; k < num_scans; ++k) tracker.follow(scans[static_cast<std::size_t>(k)], test::pose(static_cast<double>(step_m) * k, 0, 0, 0));
  EXPECT_NEAR(tracker.T_map_odom().translation().x(), 0, 0.1);
}

/// Houses of odd widths and depths along a street: corners of their fronts, and the way deep into the gaps beside them.
struct House {
  float x, y, width_m, depth_m;
};

std::vector<House> houses_along_street() {
  std::vector<House> houses;
  int i = 0;
  for (float x = -40; x < 160; ++i) {
    const float width_m = static_cast<float>(7 + i * 5 % 6);
    for (const float side : {-1.0f, 1.0f}) houses.push_back({x + (side > 0 ? 3.0f : 0.0f), side * static_cast<float>(6 + (i * 7 + (side > 0 ? 2 : 0)) % 5), width_m, side * static_cast<float>(6 + i * 3 % 4)});
    x += width_m + static_cast<float>(4 + i * 3 % 5);
  }
  return houses;
}

void front_and_sides(const House& house, const Eigen::Vector2f& shift_m, auto&& take) {
  const auto column = [&](float x, float y, const Eigen::Vector3f& normal) {
    for (const float z : {0.5f, 1.5f, 2.5f, 3.5f}) take(Eigen::Vector3f(x + shift_m.x(), y + shift_m.y(), z), normal);
  };
  for (float x = 0.5f; x < house.width_m; x += 1) column(house.x + x, house.y, Eigen::Vector3f::UnitY());
  for (float y = 0.5f; y < std::abs(house.depth_m); y += 1)
    for (const float x : {0.0f, house.width_m}) column(house.x + x, house.y + std::copysign(y, house.depth_m), Eigen::Vector3f::UnitX());
}

/// A start in another street, some of whose houses are like those of the right one: over walls alone, as of outlines without a terrain, that fits somewhat. The right street, 36 m off, fits far better.
TEST(PriorTracker, AStartThatFitsSomewhatIsLeftForAPlaceThatFitsFarBetter) {
  constexpr float sensor_z = 1.5f, step_m = 5;
  constexpr int num_scans = 9;
  const Eigen::Vector2f to_like_street_m(10, -35);
  const std::vector<House> houses = houses_along_street();
  Scene scene;
  const auto know = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& normal) { scene.know(p, normal); };
  for (std::size_t i = 0; i < houses.size(); ++i) {
    front_and_sides(houses[i], Eigen::Vector2f::Zero(), know);
    if (i % 5 == 0) front_and_sides(houses[i], to_like_street_m, know);
  }
  const test::TiledPoints tiles(scene.prior, 50);
  PriorTracker tracker(TrackingOptions{}, 1.0, NearTiles(tiles, MapFrame::local(), 150), test::pose(static_cast<double>(to_like_street_m.x()), static_cast<double>(to_like_street_m.y()), sensor_z, 0));
  for (int k = 0; k < num_scans; ++k) {
    const Eigen::Vector3f p_sensor(step_m * static_cast<float>(k), 0, sensor_z);
    scene.scan = {};
    for (const House& house : houses)
      front_and_sides(house, Eigen::Vector2f::Zero(), [&](const Eigen::Vector3f& p, const Eigen::Vector3f& normal) {
        if ((p - p_sensor).norm() < 40) scene.see(p - p_sensor, normal);
      });
    tracker.follow(scene.scan, test::pose(static_cast<double>(p_sensor.x()), 0, 0, 0));
  }
  EXPECT_TRUE(tracker.started_elsewhere());
  EXPECT_NEAR(tracker.T_map_odom().translation().head<2>().norm(), 0, 0.1);
}

}  // namespace
}  // namespace priormap
