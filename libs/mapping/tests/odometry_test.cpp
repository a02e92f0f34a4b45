#include "odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <priormap/registration/scan_reducer.hpp>

#include "street.hpp"

namespace priormap {
namespace {

/// A walker: 0.3 m a scan at 5 Hz, the sensor rocking about both axes.
Eigen::Isometry3d rocking(int k) {
  Eigen::Isometry3d T = street::pose(0.3 * k, 0, 1.2, 0);
  T.linear() = exp_so3({0.05 * std::sin(1.0 * k), 0.05 * std::cos(0.8 * k), 0}).toRotationMatrix();
  return T;
}

/// Lasers draw rings on the ground, which lie on those of the scan before where nothing has turned: they hide a motion that is not known beforehand.
TEST(Odometry, RingsOnTheGroundDoNotHideThatThePlatformBeginsRocking) {
  const street::World world = street::wide_street();
  ScanReducer reducer(1.0);
  Odometry odometry({}, Vector6d::Zero());
  for (int k = 0; k < 12; ++k) {
    SurfelCloud scan = reducer.reduce(street::scan(world, rocking(k), street::hdl32, static_cast<unsigned>(k)));
    const OdometryStep step = odometry.step(scan, 0.2 * k);
    const Eigen::Isometry3d truth = rocking(0).inverse() * rocking(k);
    EXPECT_LT(street::distance(step.T_odom_sensor, truth), 0.05) << k;
    EXPECT_LT(street::angle(step.T_odom_sensor, truth), 0.01) << k;
  }
}

/// Scans are missing in the recording, and the stamps do not tell.
TEST(Odometry, GoesOnBeyondAGapAlsoRoundACorner) {
  constexpr int before = 10;
  const street::World world = street::town(60, 3);
  for (const Eigen::Isometry3d& T_beyond : {street::pose(24, 0, 1.7, 0), street::pose(15, 3, 1.7, 0.9), street::pose(38, -1, 1.7, -0.1)}) {
    ScanReducer reducer(1.0);
    Odometry odometry({}, Vector6d::Zero());
    for (int k = 0; k < before + 5; ++k) {
      const Eigen::Isometry3d T = k < before ? street::pose(0.8 * k, 0, 1.7, 0) : T_beyond * street::pose(0.8 * (k - before), 0, 0, 0);
      SurfelCloud scan = reducer.reduce(street::scan(world, T, {}, static_cast<unsigned>(k)));
      const OdometryStep step = odometry.step(scan, 0.1 * k);
      const Eigen::Isometry3d truth = street::pose(0, 0, 1.7, 0).inverse() * T;
      EXPECT_EQ(step.joined, k > 0);
      EXPECT_LT(street::distance(step.T_odom_sensor, truth), 0.1) << T_beyond.translation().transpose() << ", scan " << k;
      EXPECT_LT(street::angle(step.T_odom_sensor, truth), 0.01) << T_beyond.translation().transpose() << ", scan " << k;
    }
  }
}

/// Houses that stand askew, nothing like a street of `town`.
street::World village() {
  street::World world;
  world.add_ground(-100, -100, 200, 100);
  for (int i = -8; i < 20; ++i) world.add_box(10 * i + 3 * (i % 3), (i % 2 ? 1 : -1) * (8 + i % 5), 7 + i % 4, 6, 9, 0.5 + 0.2 * (i % 4));
  return world;
}

/// Ten scans of a street, then another street, for so long that the first one is given up: whatever lies between them, scans of the second lie as they should to each other from its first one on.
void drive_on_elsewhere(double pause_s, int num_beyond, int first_joined) {
  constexpr int before = 10;
  constexpr street::Laser laser{.rings = 32, .columns = 500, .lowest_rad = -0.08, .highest_rad = 0.3};   // hardly any ground, which fits anywhere
  const street::World here = street::town(40, 3), there = village();
  ScanReducer reducer(1.0);
  Odometry odometry({}, Vector6d::Zero());
  Eigen::Isometry3d T_first = Eigen::Isometry3d::Identity();
  for (int k = 0; k < before + num_beyond; ++k) {
    const int beyond = k - before;
    const Eigen::Isometry3d T = street::pose(0.8 * (beyond < 0 ? k : beyond), 0, 1.7, 0);
    SurfelCloud scan = reducer.reduce(street::scan(beyond < 0 ? here : there, T, laser, static_cast<unsigned>(k)));
    const OdometryStep step = odometry.step(scan, 0.1 * k + (beyond < 0 ? 0 : pause_s));
    EXPECT_EQ(step.joined, (k > 0 && beyond < 0) || beyond >= first_joined) << beyond;
    EXPECT_EQ(step.began_anew, beyond == first_joined - 1) << beyond;
    if (beyond == 0) T_first = step.T_odom_sensor;
    if (beyond > 0) {
      EXPECT_LT(street::distance(T_first.inverse() * step.T_odom_sensor, street::pose(0, 0, 1.7, 0).inverse() * T), 0.5) << beyond;   // over 83 m, hardly any ground holding the height
    }
  }
}

TEST(Odometry, GoesOnFromTheFirstScanThatWasLost) { drive_on_elsewhere(0, 104, 100); }

TEST(Odometry, BeginsAnewWhereTheStampsTellOfAGap) { drive_on_elsewhere(8, 4, 1); }

}  // namespace
}  // namespace priormap
