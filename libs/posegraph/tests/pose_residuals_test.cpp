#include "pose_residuals.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace priormap;

namespace {

Eigen::Isometry3d random_pose(std::mt19937& random, double angle = 1.0, double distance = 10.0) {
  std::uniform_real_distribution<double> u(-1, 1);
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = u(random) * (i < 3 ? angle : distance);
  return retract(Eigen::Isometry3d::Identity(), xi);
}

template <class Residual>
Matrix6d numeric_jacobian(const Eigen::Isometry3d& T, const Residual& residual) {
  constexpr double h = 1e-6;
  Matrix6d J;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = h * Vector6d::Unit(i);
    J.col(i) = (residual(retract(T, step)) - residual(retract(T, -step))) / (2 * h);
  }
  return J;
}

TEST(PoseResiduals, AnalyticJacobiansMatchNumericOnes) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Isometry3d a = random_pose(random), b = random_pose(random), m = random_pose(random);
    const AbsoluteResidual absolute = absolute_residual(m, a);
    EXPECT_LT((absolute.J - numeric_jacobian(a, [&](const auto& T) { return absolute_residual(m, T).r; })).cwiseAbs().maxCoeff(), 1e-7);
    const BetweenResidual between = between_residual(m, a, b);
    EXPECT_LT((between.J_a - numeric_jacobian(a, [&](const auto& T) { return between_residual(m, T, b).r; })).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_LT((between.J_b - numeric_jacobian(b, [&](const auto& T) { return between_residual(m, a, T).r; })).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(PoseResiduals, ABetweenResidualDependsOnTheEarlierPose) {
  std::mt19937 random(2);
  const Eigen::Isometry3d a = random_pose(random), b = random_pose(random), m = a.inverse() * b;
  EXPECT_LT(between_residual(m, a, b).r.norm(), 1e-12);
  Eigen::Isometry3d moved = a;
  moved.translation().x() += 0.5;
  EXPECT_NEAR(between_residual(m, moved, b).r.tail<3>().norm(), 0.5, 1e-12);
  const Eigen::Isometry3d whole = random_pose(random, 3.0, 1000.0);  // both moved alike: nothing changes
  EXPECT_LT(between_residual(m, whole * a, whole * b).r.norm(), 1e-9);
}

TEST(PoseResiduals, RetractAndLocalCoordinatesAreInverse) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Isometry3d a = random_pose(random), b = random_pose(random);
    EXPECT_TRUE(retract(a, local_coordinates(a, b)).isApprox(b, 1e-12));
  }
}

}  // namespace
