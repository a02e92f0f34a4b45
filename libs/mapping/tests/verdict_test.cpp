#include <gtest/gtest.h>

#include <numbers>

#include <priormap/mapping/mapped_scan.hpp>

namespace priormap {
namespace {

/// At a heading of 90 degrees (facing north), with sigmas along the sensor's axes: forward, left, up.
MappedScan placed(const Eigen::Vector3d& sigma_m) {
  MappedScan scan;
  scan.verdict = Verdict::anchored;
  scan.T_map_sensor.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  scan.covariance.bottomRightCorner<3, 3>() = sigma_m.cwiseAbs2().asDiagonal();
  return scan;
}

TEST(Verdict, APoseThatIsHeldInEveryDirectionIsAnchored) {
  MappedScan scan = placed({0.1, 0.2, 0.05});
  judge(scan, true);
  EXPECT_EQ(scan.verdict, Verdict::anchored);
  EXPECT_EQ(direction_text(scan.weak_axis), "");
}

TEST(Verdict, AWeakPoseNamesItsDirection) {
  const auto direction = [](const Eigen::Vector3d& sigma_m) {
    MappedScan scan = placed(sigma_m);
    judge(scan, true);
    EXPECT_EQ(scan.verdict, Verdict::weak);
    return direction_text(scan.weak_axis);
  };
  EXPECT_EQ(direction({2, 0.1, 0.1}), "000");   // along the street, which runs north
  EXPECT_EQ(direction({0.1, 2, 0.1}), "090");
  EXPECT_EQ(direction({0.1, 0.1, 1}), "up");
}

TEST(Verdict, WhatThePriorContradictsIsDeadReckonedHoweverSure) {
  MappedScan scan = placed({0.1, 0.1, 0.1});
  scan.contradicted = true;
  judge(scan, true);
  EXPECT_EQ(scan.verdict, Verdict::dead_reckoned);
}

TEST(Verdict, ACovarianceThatIsNotCalibratedTellsTheDirectionAlone) {
  MappedScan scan = placed({2, 0.1, 0.1});
  judge(scan, false);
  EXPECT_EQ(scan.verdict, Verdict::anchored);
  scan.verdict = Verdict::weak;
  judge(scan, false);
  EXPECT_EQ(direction_text(scan.weak_axis), "000");
}

TEST(Verdict, WhatIsLostStaysLost) {
  MappedScan scan = placed({9, 9, 9});
  scan.verdict = Verdict::lost;
  judge(scan, true);
  EXPECT_EQ(scan.verdict, Verdict::lost);
}

TEST(Verdict, DirectionsAreAzimuthsWithoutASense) {
  EXPECT_EQ(direction_text({1, 1, 0}), direction_text({-1, -1, 0}));
  EXPECT_EQ(direction_text(Eigen::Vector3d(std::sin(0.5), std::cos(0.5), 0)), "029");
  EXPECT_EQ(direction_text(Eigen::Vector3d(-1e-4, 1, 0).normalized()), "000");
}

}  // namespace
}  // namespace priormap
