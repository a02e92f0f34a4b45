#include <gtest/gtest.h>

#include <priormap/registration/scan_reducer.hpp>

#include "sweep_motion.hpp"

namespace priormap {
namespace {

const Vector6d turning = (Vector6d() << 0.1, -0.2, 0.8, 15, 1, -0.5).finished();   // rad/s, m/s: a car in a sharp bend

Eigen::Isometry3d somewhere() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3({0.3, -0.2, 2}).toRotationMatrix();
  T.translation() << 10, -20, 3;
  return T;
}

TEST(SweepMotion, TheVelocityLeadsFromOnePoseToTheOther) {
  const Eigen::Isometry3d from = somewhere(), to = moved_on(from, turning, 0.1);
  EXPECT_LT((steady_velocity(from, to, 0.1) - turning).norm(), 1e-9);
}

TEST(SweepMotion, TwoStepsAreOneOfBothTimes) {
  const Eigen::Isometry3d T = somewhere();
  EXPECT_TRUE(moved_on(moved_on(T, turning, 0.03), turning, 0.07).isApprox(moved_on(T, turning, 0.1), 1e-12));
}

/// A point of the world, measured from where the sensor is at each time.
PointCloud swept(const Eigen::Vector3d& p_world, const std::vector<float>& times_s) {
  PointCloud scan;
  scan.time_s = times_s;
  for (const float t : times_s) scan.xyz.push_back((moved_on(somewhere(), turning, static_cast<double>(t)).inverse() * p_world).cast<float>());
  return scan;
}

TEST(SweepMotion, APointOfTheWorldComesToOnePlace) {
  const Eigen::Vector3d p_sensor(60, -30, 5);
  PointCloud scan = swept(somewhere() * p_sensor, {-0.05f, -0.02f, 0, 0.03f, 0.05f});
  EXPECT_GT((scan.xyz.front().cast<double>() - p_sensor).norm(), 1);
  undo_motion(scan, turning);
  for (const Eigen::Vector3f& p : scan.xyz) EXPECT_LT((p.cast<double>() - p_sensor).norm(), 1e-3);
}

TEST(SweepMotion, ASurfelMovesByTheMeanTimeOfItsPoints) {
  const Eigen::Vector3d p_sensor(20.4, 10.4, 1.4);
  PointCloud scan = swept(somewhere() * p_sensor, {0.010f, 0.012f, 0.014f});
  SurfelCloud surfels = ScanReducer(1).reduce(scan);
  ASSERT_EQ(surfels.size(), 1u);
  EXPECT_NEAR(surfels.surfels.front().time_s, 0.012, 1e-6);
  undo_motion(surfels, turning);
  EXPECT_LT((surfels.surfels.front().mean.cast<double>() - p_sensor).norm(), 1e-3);
}

/// One surfel, of which those around it tell that it lies on a wall ahead.
SurfelCloud trace_on_a_wall(float time_s) {
  SurfelCloud scan;
  scan.surfels = {{.mean = {20, 0, 0}, .count = 20, .time_s = time_s}};
  scan.around = {{.normal = Eigen::Vector3f::UnitX(), .directed = 1}};
  return scan;
}

TEST(SweepMotion, WhatThoseAroundASurfelTellTurnsWithIt) {
  constexpr float time_s = 0.05f;
  SurfelCloud scan = trace_on_a_wall(time_s);
  undo_motion(scan, turning);
  const Eigen::Matrix3d turned = exp_so3(static_cast<double>(time_s) * turning.head<3>()).toRotationMatrix();
  EXPECT_LT((scan.around.front().normal.cast<double>() - turned.col(0)).norm(), 1e-4);
}

TEST(SweepMotion, WhatThoseAroundASurfelTellMovesToAnotherFrameWithIt) {
  SurfelCloud scan = trace_on_a_wall(0);
  move(scan, somewhere());
  EXPECT_LT((scan.surfels.front().mean.cast<double>() - somewhere() * Eigen::Vector3d(20, 0, 0)).norm(), 1e-4);
  EXPECT_LT((scan.around.front().normal.cast<double>() - somewhere().linear().col(0)).norm(), 1e-6);
}

TEST(SweepMotion, WithoutTimesNothingMoves) {
  PointCloud scan;
  scan.xyz = {{10, 2, 1}};
  undo_motion(scan, turning);
  EXPECT_EQ(scan.xyz.front(), Eigen::Vector3f(10, 2, 1));
  SurfelCloud surfels = ScanReducer(1).reduce(scan);
  undo_motion(surfels, turning);
  EXPECT_LT((surfels.surfels.front().mean - Eigen::Vector3f(10, 2, 1)).norm(), 1e-6f);
}

}  // namespace
}  // namespace priormap
