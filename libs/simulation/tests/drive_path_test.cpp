#include <priormap/simulation/drive_path.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

Eigen::Isometry3d pose(double x, double y, double z, double yaw) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << x, y, z;
  return T;
}

TEST(DrivePath, PassesThroughItsPosesAndGoesStraightBetweenAndBeyond) {
  const DrivePath path{{0, 0.1, 0.2, 0.3}, {pose(0, 0, 1, 0), pose(1, 0, 1, 0), pose(2, 0, 1, 0), pose(3, 0, 1, 0)}};
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_TRUE(path.pose(path.stamps_s[i]).isApprox(path.poses[i], 1e-9));
  EXPECT_TRUE(path.pose(0.13).isApprox(pose(1.3, 0, 1, 0), 1e-9));
  EXPECT_TRUE(path.pose(-0.05).isApprox(pose(-0.5, 0, 1, 0), 1e-9));
  EXPECT_TRUE(path.pose(0.35).isApprox(pose(3.5, 0, 1, 0), 1e-9));
}

TEST(DrivePath, RoundsACircleBetweenItsPoses) {
  DrivePath path;
  const auto on_circle = [](double t) { return pose(20 * std::sin(t), 20 - 20 * std::cos(t), 0, t); };
  for (double t = 0; t < 1; t += 0.05) {
    path.stamps_s.push_back(t);
    path.poses.push_back(on_circle(t));
  }
  for (double t = 0.06; t < 0.85; t += 0.013) {
    EXPECT_LT((path.pose(t).translation() - on_circle(t).translation()).norm(), 1e-3);
    EXPECT_LT((path.pose(t).linear() - on_circle(t).linear()).norm(), 1e-6);
  }
}

TEST(Ride, SensorStandsAboveTheGroundAndTiltsWithIt) {
  const Terrain slope({-50, -50, 50, 50}, 1, [](const Eigen::Vector2d& p) { return 10 + 0.1 * p.x() + 0.05 * p.y(); });
  PlatformOptions platform;
  platform.wobble_deg = 0;
  const DrivePath path = ride({{0, {3, 4}, 0}, {0.1, {4, 4}, std::numbers::pi / 2}}, slope, platform, 1);
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.1, -0.05, 1).normalized();
  for (const auto& T_map_sensor : path.poses) {
    EXPECT_NEAR(T_map_sensor.linear().col(2).dot(normal), 1, 1e-4);
    const Eigen::Vector3d foot = T_map_sensor * Eigen::Vector3d(0, 0, -platform.mount_height_m);
    EXPECT_NEAR(foot.z(), 10 + 0.1 * foot.x() + 0.05 * foot.y(), 1e-3);
  }
  EXPECT_GT(path.poses[0].linear()(2, 0), 0.09) << "uphill, the front looks up";
  EXPECT_GT(path.poses[1].linear()(0, 1), -1.01);
}

TEST(Ride, WobbleStaysWithinItsAmplitude) {
  const Terrain flat({-50, -50, 50, 50}, 1, [](const Eigen::Vector2d&) { return 0.0; });
  PlatformOptions platform;
  platform.wobble_deg = 3;
  std::vector<TrackPoint> track;
  for (int i = 0; i < 200; ++i) track.push_back({0.1 * i, {0, 0}, 0});
  double largest = 0;
  for (const auto& T : ride(track, flat, platform, 1).poses) largest = std::max(largest, std::acos(T.linear()(2, 2)));
  EXPECT_GT(largest, 1.0 * std::numbers::pi / 180);
  EXPECT_LT(largest, 4.3 * std::numbers::pi / 180);
}

TEST(DriveAlong, KeepsRightAndSlowsInBends) {
  const auto track = drive_along({{0, 0}, {100, 0}, {100, 100}}, 1.5, {10, 10}, 400);
  ASSERT_GT(track.size(), 150u);
  double slowest = 1e9;
  for (std::size_t i = 1; i < track.size(); ++i) {
    const double speed_mps = (track[i].position - track[i - 1].position).norm() * 10;
    EXPECT_LT(speed_mps, 11);
    EXPECT_LT(std::abs(track[i].yaw - track[i - 1].yaw), 0.08);
    slowest = std::min(slowest, speed_mps);
    if (track[i].position.x() < 70) {
      EXPECT_NEAR(track[i].position.y(), -1.5, 1e-6);
    }
  }
  EXPECT_LT(slowest, 6);
  EXPECT_NEAR(track.back().position.x(), 101.5, 0.1);
  EXPECT_NEAR(track.back().yaw, std::numbers::pi / 2, 1e-3);
}

/// Nothing a car cannot do: tight turns, sharp jolts, slipping sideways.
void expect_car_like(const std::vector<TrackPoint>& track, double rate_hz) {
  constexpr double turning_radius_m = 5;
  for (std::size_t i = 1; i < track.size(); ++i) {
    const Eigen::Vector2d step = track[i].position - track[i - 1].position;
    const double turn = track[i].yaw - track[i - 1].yaw, yaw = 0.5 * (track[i].yaw + track[i - 1].yaw);
    EXPECT_LT(std::abs(turn), 1.02 * step.norm() / turning_radius_m + 0.02) << "scan " << i;
    EXPECT_LT(std::abs(turn) * rate_hz * step.norm() * rate_hz, 3) << "scan " << i << ": lateral acceleration";
    const Eigen::Vector2d left(-std::sin(yaw), std::cos(yaw));
    EXPECT_LT(std::abs(step.dot(left)), 0.03) << "scan " << i;
  }
}

TEST(DriveAlong, TurnsBackLikeACarWhereAStreetEnds) {
  const double half_width_m = 5;
  const auto track = drive_along({{0, 0}, {60, 0}, {0, 0}}, 1.5, {8, 10}, 400);
  expect_car_like(track, 10);
  bool backward = false;
  for (std::size_t i = 1; i < track.size(); ++i) {
    const Eigen::Vector2d step = track[i].position - track[i - 1].position;
    backward |= step.dot(Eigen::Vector2d(std::cos(track[i].yaw), std::sin(track[i].yaw))) < -0.01;
    EXPECT_LT(std::abs(track[i].position.y()), half_width_m);
    EXPECT_LT(track[i].position.x(), 60) << "the car stays on the street";
  }
  EXPECT_TRUE(backward) << "a street of 10 m has no room to turn in one go";
  EXPECT_NEAR(track.back().yaw, std::numbers::pi, 0.01) << "to the left";
  EXPECT_NEAR(track.back().position.y(), 1.5, 0.05) << "on the other lane";
  EXPECT_LT(track.back().position.x(), 2);
}

TEST(DriveAlong, IsCarLikeAtAnyCorner) {
  for (const double corner_deg : {30., 60., 90., 110., 119., 121., 140., 165., 179., -45., -90., -119., -125., -149., -151., -175.}) {
    SCOPED_TRACE(corner_deg);
    const double corner = corner_deg * std::numbers::pi / 180;
    const Eigen::Vector2d junction(40, 0), end = junction + 40 * Eigen::Vector2d(std::cos(corner), std::sin(corner));
    const auto track = drive_along({{0, 0}, junction, end}, 1.5, {8, 10}, 600);
    expect_car_like(track, 10);
    EXPECT_LT((track.back().position - end).norm(), 2.5);
    EXPECT_NEAR(std::remainder(track.back().yaw - corner, 2 * std::numbers::pi), 0, 0.02);
  }
}

/// Ends of streets too short to turn in, one after the other: the drive goes on.
TEST(DriveAlong, GetsOutOfAnyStreetGraph) {
  const auto track = drive_along({{0, 0}, {30, 0}, {33, 0}, {30, 0}, {30, 4}, {30, 0}, {0, 0}}, 1.5, {8, 10}, 2000);
  expect_car_like(track, 10);
  EXPECT_LT((track.back().position - Eigen::Vector2d(0, 0)).norm(), 3);
}

TEST(RecordedPoses, CameraAxesBecomeLidarAxes) {
  const auto file = std::filesystem::path(testing::TempDir()) / "camera_poses.txt";
  // 2 m forward (camera z), 1 m to the right (camera x), then turned right by 90 degrees about camera y (down).
  std::ofstream(file) << "1 0 0 0 0 1 0 0 0 0 1 0\n0 0 1 1 0 1 0 0 -1 0 0 2\n";
  const RecordedPoses recorded = read_recorded_poses(file, "camera");
  ASSERT_EQ(recorded.poses.size(), 2u);
  EXPECT_TRUE(recorded.stamps_s.empty());
  EXPECT_TRUE(recorded.poses[1].isApprox(pose(2, -1, 0, -std::numbers::pi / 2), 1e-9));
}

TEST(RecordedPoses, ReadsTumAndNamesABrokenLine) {
  const auto file = std::filesystem::path(testing::TempDir()) / "poses.txt";
  std::ofstream(file) << "# stamp x y z qx qy qz qw\n0.5 1 2 3 0 0 0.7071067811865476 0.7071067811865476\n";
  const RecordedPoses recorded = read_recorded_poses(file, "lidar");
  ASSERT_EQ(recorded.stamps_s, std::vector<double>{0.5});
  EXPECT_TRUE(recorded.poses[0].isApprox(pose(1, 2, 3, std::numbers::pi / 2), 1e-9));
  std::ofstream(file) << "0 1 2 3 0 0 0 1\n1 2 3\n";
  try {
    read_recorded_poses(file, "lidar");
    FAIL();
  } catch (const FormatError& error) {
    EXPECT_NE(std::string(error.what()).find("line 2"), std::string::npos);
  }
  EXPECT_THROW(read_recorded_poses("/nowhere/poses.txt", "lidar"), IoError);
}

TEST(RecordedPoses, KittiSequenceIsAsLongAsItsRoad) {
  const char* shared = std::getenv("PRIORMAP_SHARED_DATA");
  const std::filesystem::path data = shared ? shared : PRIORMAP_SOURCE_DIR "/../shared/data";
  const auto file = data / "poses/kitti_odometry_gt/00.txt";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the real inputs are absent";
  const RecordedPoses recorded = read_recorded_poses(file, "camera");
  ASSERT_EQ(recorded.poses.size(), 4541u);
  double length_m = 0, forward_m = 0;
  for (std::size_t i = 1; i < recorded.poses.size(); ++i) {
    const Eigen::Vector3d step = recorded.poses[i].translation() - recorded.poses[i - 1].translation();
    length_m += step.norm();
    forward_m += step.dot(recorded.poses[i - 1].linear().col(0));
  }
  EXPECT_NEAR(length_m, 3724, 2);
  EXPECT_GT(forward_m, 0.99 * length_m) << "the car drives along its x axis";
}

}  // namespace
}  // namespace priormap
