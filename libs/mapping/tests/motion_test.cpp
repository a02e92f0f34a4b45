#include <gtest/gtest.h>

#include <priormap/mapping/motion.hpp>

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

}  // namespace
}  // namespace priormap
