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

}  // namespace
}  // namespace priormap
