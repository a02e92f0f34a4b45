#include "odometry.hpp"

#include <gtest/gtest.h>

#include <functional>

#include <cmath>

#include <priormap/mapping/motion.hpp>
#include <priormap/registration/scan_reducer.hpp>

#include "scans_of_street.hpp"
#include "street.hpp"
#include "sweep_motion.hpp"

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

/// The ring of a laser is a line as wide as its noise, which travels with the sensor; of few lasers hardly anything else is seen.
TEST(Odometry, FollowsASensorOfSixteenLasers) {
  const street::World world = street::town(60, 3);
  ScanReducer reducer(1.0);
  Odometry odometry({}, (Vector6d() << Eigen::Vector3d::Zero(), 8, 0, 0).finished());
  for (int k = 0; k < 20; ++k) {
    const Eigen::Isometry3d T = street::pose(0.8 * k, 0.05 * k, 1.7, 0.01 * k);
    SurfelCloud scan = reducer.reduce(street::scan(world, T, street::vlp16, static_cast<unsigned>(k)));
    EXPECT_LT(street::distance(odometry.step(scan, 0.1 * k).T_odom_sensor, street::pose(0, 0, 1.7, 0).inverse() * T), 0.1) << k;
  }
}

/// How far it says that it drove where little but piers tells, of how far it did.
double share_driven(const test::ScansOfStreet& scans) {
  ScanReducer reducer(1.0);
  Odometry odometry({}, steady_velocity(Eigen::Isometry3d::Identity(), motion_at_start(scans, 0, scans.size()), period_at_start(scans, 0, scans.size())));
  OdometryStep step;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    SurfelCloud scan = reducer.reduce(scans.read(k).points);
    step = odometry.step(scan, scans.stamp_s(k));
    EXPECT_EQ(step.joined, k > 0) << k;
  }
  const Eigen::Isometry3d truth = scans.pose(0).inverse() * scans.pose(scans.size() - 1);
  EXPECT_LT((step.T_odom_sensor.translation() - truth.translation()).tail<2>().norm(), 0.2);
  EXPECT_LT(street::angle(step.T_odom_sensor, truth), 0.01);
  return step.T_odom_sensor.translation().x() / truth.translation().x();
}

TEST(Odometry, OfSixteenLasersFollowsACarThatSetsOffInAStreetOfWalls) {
  const auto way_m = [](double t_s) { return t_s < 3 ? 5.0 / 3 * t_s * t_s : 15 + 10 * (t_s - 3); };   // to 10 m/s
  EXPECT_NEAR(share_driven(test::ScansOfStreet(street::canyon_with_piers(), street::vlp16, 36, way_m)), 1, 0.01);
}

TEST(Odometry, OfSixteenLasersFollowsACarThatIsAtSpeedInAStreetOfWalls) {
  for (const double first_x : {0.0, 10.0, 30.0})
    EXPECT_NEAR(share_driven(test::ScansOfStreet(street::canyon_with_piers(), street::vlp16, 20, [&](double t_s) { return first_x + 14 * t_s; })), 1, 0.01) << first_x;
}

/// A sweep of 0.1 s, clockwise, as a moving sensor sees it. @param first_time_s  of its points, from the stamp
PointCloud sweep_of(const street::World& world, const std::function<Eigen::Isometry3d(double t_s)>& truth, double stamp_s, unsigned seed, double first_time_s = 0) {
  const double middle_s = first_time_s + 0.05;
  const Eigen::Isometry3d middle = truth(stamp_s + middle_s);
  PointCloud sweep = street::scan(world, middle, {.rings = 32, .columns = 500}, seed);
  for (Eigen::Vector3f& p : sweep.xyz) {
    const double time_s = middle_s - 0.1 * std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x())) / (2 * M_PI);
    sweep.time_s.push_back(static_cast<float>(time_s));
    p = (truth(stamp_s + time_s).inverse() * middle * p.cast<double>()).cast<float>();
  }
  return sweep;
}

/// By a clock that is put back, one that repeats itself, one that stands, and one that hardly moves.
TEST(Odometry, StampsThatTellNoTimeTellNoMotion) {
  const street::World world = street::town(60, 3);
  const auto truth = [](double t_s) { return street::pose(10 * t_s, 0, 1.7, 0); };
  const auto put_back = [](int k) { return 0.1 * k - (k >= 10 ? 5 : 0); };
  const auto repeated = [](int k) { return 0.1 * (k - (k >= 10 ? 1 : 0)); };
  const auto standing = [](int) { return 0.0; };
  const auto hardly_moving = [](int k) { return 1e-9 * k; };
  for (const std::function<double(int)>& stamp_s : std::initializer_list<std::function<double(int)>>{put_back, repeated, standing, hardly_moving})
    for (const double first_time_s : {0.0, -0.1}) {
      ScanReducer reducer(1.0);
      Odometry odometry({}, (Vector6d() << Eigen::Vector3d::Zero(), 10, 0, 0).finished());
      for (int k = 0; k < 20; ++k) {
        SurfelCloud scan = reducer.reduce(sweep_of(world, truth, 0.1 * k, static_cast<unsigned>(k), first_time_s));
        const OdometryStep step = odometry.step(scan, stamp_s(k));
        EXPECT_TRUE(k == 0 || step.joined) << k;
        EXPECT_NEAR(step.velocity[3], 10, 0.5) << stamp_s(10) << ' ' << first_time_s << ' ' << k;
        EXPECT_LT(street::distance(step.T_odom_sensor, truth(0).inverse() * truth(0.1 * k)), 0.05) << stamp_s(10) << ' ' << first_time_s << ' ' << k;
      }
    }
}

/// Into a turn and to a stop.
TEST(Odometry, SweepsAreStraightInATurnAndAtAStop) {
  const street::World world = street::town(60, 3);
  const auto truth = [](double t_s) {   // 4 m/s, slowed down from 1.5 s on, to rest at 2.5 s; turning by 8 degrees a second from 0.5 s on
    const double braking_s = std::clamp(t_s - 1.5, 0.0, 1.0), way_m = 4 * (std::min(t_s, 2.5) - braking_s) + 4 * braking_s - 2 * braking_s * braking_s;
    const double yaw = 0.035 * std::clamp(way_m - 2, 0.0, 100.0), radius_m = 1 / 0.035;
    return way_m < 2 ? street::pose(way_m, 0, 1.7, 0) : street::pose(2 + radius_m * std::sin(yaw), radius_m * (1 - std::cos(yaw)), 1.7, yaw);
  };
  ScanReducer reducer(1.0);
  Odometry odometry({}, (Vector6d() << Eigen::Vector3d::Zero(), 4, 0, 0).finished());
  for (int k = 0; k < 35; ++k) {
    const double stamp_s = 0.1 * k;
    SurfelCloud scan = reducer.reduce(sweep_of(world, truth, stamp_s, static_cast<unsigned>(k)));
    const OdometryStep step = odometry.step(scan, stamp_s);
    const Eigen::Isometry3d T = truth(0).inverse() * truth(stamp_s);
    EXPECT_LT(street::distance(step.T_odom_sensor, T), 0.1) << k;
    EXPECT_LT(street::angle(step.T_odom_sensor, T), 0.01) << k;
  }
}

/// More than a second without a scan: the first one beyond fits, and tells how far it went in that time.
TEST(Odometry, BeyondAPauseTheVelocityIsTheWayByTheTimeThatItTook) {
  constexpr int before = 10;
  constexpr double speed_m_s = 8, pause_s = 1.1;
  const street::World world = street::town(60, 3);
  ScanReducer reducer(1.0);
  Odometry odometry({}, (Vector6d() << Eigen::Vector3d::Zero(), speed_m_s, 0, 0).finished());
  for (int k = 0; k <= before; ++k) {
    const double stamp_s = 0.1 * k + (k < before ? 0 : pause_s);
    SurfelCloud scan = reducer.reduce(street::scan(world, street::pose(speed_m_s * stamp_s, 0, 1.7, 0), {}, static_cast<unsigned>(k)));
    const OdometryStep step = odometry.step(scan, stamp_s);
    EXPECT_EQ(step.joined, k > 0) << k;
    if (k == before) {
      EXPECT_NEAR(step.velocity[3], speed_m_s, 0.05);
    }
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

/// A lorry beside the sensor: what it hides seems to lie elsewhere.
void hide_a_quarter(SurfelCloud& scan) {
  for (std::size_t i = 0; i < scan.size() / 4; ++i) scan.surfels[4 * i].mean.z() += 0.6f + 0.1f * static_cast<float>(i % 9);
}

/// A search in vain does not stand in the way of the next one, however seldom scans fit worse than usual.
TEST(Odometry, ALorryLongAgoHidesNoGap) {
  constexpr int lorry_at = 8, before = 24;
  const street::World world = street::town(60, 3);
  ScanReducer reducer(1.0);
  Odometry odometry({}, Vector6d::Zero());
  for (int k = 0; k < before + 3; ++k) {
    const Eigen::Isometry3d T = k < before ? street::pose(0.4 * k, 0, 1.7, 0) : street::pose(15, 3, 1.7, 0.9) * street::pose(0.4 * (k - before), 0, 0, 0);
    SurfelCloud scan = reducer.reduce(street::scan(world, T, {}, static_cast<unsigned>(k)));
    if (k == lorry_at) hide_a_quarter(scan);
    const OdometryStep step = odometry.step(scan, 0.1 * k);
    EXPECT_LT(street::distance(step.T_odom_sensor, street::pose(0, 0, 1.7, 0).inverse() * T), 0.1) << k;
  }
}

TEST(Odometry, APauseAndALorryThrowNoDriveAway) {
  constexpr int before = 10;
  const street::World world = street::town(60, 3);
  ScanReducer reducer(1.0);
  Odometry odometry({}, Vector6d::Zero());
  for (int k = 0; k < before + 4; ++k) {
    const Eigen::Isometry3d T = street::pose(0.8 * k + (k < before ? 0 : 1.2), 0, 1.7, 0);
    SurfelCloud scan = reducer.reduce(street::scan(world, T, {}, static_cast<unsigned>(k)));
    if (k == before) hide_a_quarter(scan);
    const OdometryStep step = odometry.step(scan, 0.1 * k + (k < before ? 0 : 1.3));
    EXPECT_FALSE(step.began_anew);
    if (k > before) {
      EXPECT_LT(street::distance(step.T_odom_sensor, street::pose(0, 0, 1.7, 0).inverse() * T), 0.05) << k;
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

TEST(Odometry, BeginsAnewWhereTheStampsTellOfAGap) { drive_on_elsewhere(8, 9, 5); }

}  // namespace
}  // namespace priormap
