#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <priormap/registration/observability.hpp>

using namespace priormap;

namespace {

TEST(Observability, SigmasAreThoseOfTheMarginals) {
  Matrix6d A;
  for (int i = 0; i < 36; ++i) A(i) = std::sin(1.0 + i * i);
  const Matrix6d information = A * A.transpose() + 0.1 * Matrix6d::Identity();
  const Matrix6d covariance = information.inverse();
  const Observability o = observability(information);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d t = o.translation_axes.col(i), r = o.rotation_axes.col(i);
    EXPECT_NEAR(o.translation_sigma_m[i], std::sqrt(t.dot(covariance.bottomRightCorner<3, 3>() * t)), 1e-9 * o.translation_sigma_m[0]);
    EXPECT_NEAR(o.rotation_sigma_rad[i], std::sqrt(r.dot(covariance.topLeftCorner<3, 3>() * r)), 1e-9 * o.rotation_sigma_rad[0]);
  }
  EXPECT_GE(o.translation_sigma_m[0], o.translation_sigma_m[1]);
}

TEST(Observability, ADirectionWithoutInformationIsInfinitelyUncertain) {
  Matrix6d information = Matrix6d::Identity();
  information.row(3).setZero();
  information.col(3).setZero();
  const Observability o = observability(information);
  EXPECT_EQ(o.translation_sigma_m[0], INFINITY);
  EXPECT_NEAR(std::abs(o.translation_axes(0, 0)), 1, 1e-12);
  EXPECT_NEAR(o.translation_sigma_m[1], 1, 1e-12);
  EXPECT_EQ(observability(Matrix6d::Zero()).rotation_sigma_rad[2], INFINITY);
}

}  // namespace
