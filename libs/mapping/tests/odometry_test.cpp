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

}  // namespace
}  // namespace priormap
