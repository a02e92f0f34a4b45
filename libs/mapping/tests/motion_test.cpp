#include <gtest/gtest.h>

#include <priormap/mapping/motion.hpp>

#include "scans_of_street.hpp"

namespace priormap {
namespace {

Eigen::Isometry3d pose(double yaw, double pitch, const Eigen::Vector3d& t) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY())).toRotationMatrix();
  T.translation() = t;
  return T;
}

TEST(Motion, PredictionGoesOnByTheSameStep) {
  const auto before = pose(0.3, 0.1, {1, 2, 3}), last = pose(0.5, -0.1, {2, 2.5, 3.1});
  const auto next = predict(before, last);
  EXPECT_LT((next.translation() - Eigen::Vector3d(3, 3, 3.2)).norm(), 1e-12);
  const Eigen::Quaterniond q0(before.linear()), q1(last.linear());
  // slerp(q0, q1, 2) written through half the way back: q1 is the middle of q0 and the prediction.
  const Eigen::Quaterniond middle = q0.slerp(0.5, Eigen::Quaterniond(next.linear()));
  EXPECT_LT(middle.angularDistance(q1), 1e-7);
}

TEST(Motion, WhatStandsStillStays) {
  const auto T = pose(2.0, 0.2, {5, 6, 7});
  EXPECT_TRUE(predict(T, T).isApprox(T, 1e-12));
}

/// The first three scans of a drive.
Eigen::Isometry3d motion_from(double x, double m_s, double m_s2) {
  const auto way_m = [&](double t_s) { return x + m_s * t_s + m_s2 / 2 * t_s * t_s; };
  return motion_at_start(test::ScansOfStreet(street::canyon_with_piers(), street::vlp16, 3, way_m), 0, 3);
}

TEST(MotionAtStart, OfSixteenLasersIsFoundAtSpeed) {
  for (const auto& [x, m_s] : {std::pair(0.0, 10.0), {0.0, 15.0}, {0.0, 20.0}, {10.0, 15.0}, {10.0, 20.0}})
    EXPECT_LT(street::distance(motion_from(x, m_s, 0), pose(0, 0, {0.1 * m_s, 0, 0})), 0.03) << x << " m, " << m_s << " m/s";
}

TEST(MotionAtStart, OfSixteenLasersIsFoundFromRest) {
  for (const double x : {0.0, 10.0, 55.0}) {
    EXPECT_LT(street::distance(motion_from(x, 0, 0), Eigen::Isometry3d::Identity()), 0.01) << x;
    EXPECT_LT(street::distance(motion_from(x, 0, 2.5), pose(0, 0, {0.0375, 0, 0})), 0.03) << x;
  }
}

/// Level ground fits level ground anywhere.
TEST(MotionAtStart, WhereNothingTellsOfOneIsRest) {
  const auto way_m = [](double t_s) { return 5 * t_s; };
  street::World field;
  field.add_ground(-100, -100, 100, 100);
  for (const street::Laser& laser : {street::vlp16, street::hdl32, street::Laser{}})
    EXPECT_LT(street::distance(motion_at_start(test::ScansOfStreet(field, laser, 3, way_m), 0, 3), Eigen::Isometry3d::Identity()), 0.03);
}

}  // namespace
}  // namespace priormap
