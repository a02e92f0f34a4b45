#include <gtest/gtest.h>

#include <numbers>

#include "made_trajectories.hpp"
#include <priormap/evaluation/evaluate.hpp>

namespace priormap {
namespace {

std::string warning(const Trajectory& reference, const Trajectory& estimate, Alignment align = Alignment::none) {
  std::string text;
  Events events;
  events.warning = [&](const std::string& message) { text += message; };
  EvaluationOptions options;
  options.align = align;
  evaluate_trajectory(reference, estimate, options, events);
  return text;
}

/// x forward, y left, z up seen in the axes of a camera.
Eigen::Isometry3d camera_from_lidar() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return T;
}

TEST(TurnedFrames, TheAxesOfACameraAreNamed) {
  const Trajectory lidar = made::winding(200);
  Trajectory camera = lidar;
  made::transform(camera, camera_from_lidar() * made::pose(5, 3, 1, 2.0));   // wherever it began, whatever the heading
  EXPECT_NE(warning(camera, lidar).find("the reference's axes are those of a camera"), std::string::npos) << warning(camera, lidar);
  EXPECT_NE(warning(camera, lidar).find("--kitti-calib"), std::string::npos);
  EXPECT_NE(warning(lidar, camera).find("the estimate's axes are those of a camera"), std::string::npos);
  EXPECT_EQ(warning(camera, lidar, Alignment::se3), "");
}

TEST(TurnedFrames, OtherTurnsAreToldWithTheirAngle) {
  Trajectory estimate = made::winding(200);
  made::transform(estimate, made::pose(0, 0, 0, std::numbers::pi / 2));
  EXPECT_NE(warning(made::winding(200), estimate).find("a turn by 90 degrees"), std::string::npos);
}

TEST(TurnedFrames, ShiftsAndSmallErrorsAreNoTurns) {
  Trajectory shifted = made::winding(200), drifting = made::winding(200);
  made::transform(shifted, made::pose(3, -20, 0));
  for (std::size_t i = 0; i < drifting.size(); ++i) drifting.poses[i].translation().x() += 0.02 * double(i);
  EXPECT_EQ(warning(made::winding(200), shifted), "");
  EXPECT_EQ(warning(made::winding(200), drifting), "");
  // Least squares turn a straight way about itself as its noise has it.
  Trajectory straight = made::straight(100, 1), beside = straight;
  for (std::size_t i = 0; i < 100; ++i) {
    straight.poses[i].translation().y() += 0.05 * double(i % 2);
    beside.poses[i].translation() += Eigen::Vector3d(0, 4, -0.05 * double(i % 2));
  }
  EXPECT_EQ(warning(straight, beside), "");
}

}  // namespace
}  // namespace priormap
