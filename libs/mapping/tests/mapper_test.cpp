#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <random>

#include <priormap/mapping/mapper.hpp>

#include "street.hpp"
#include "sweep_motion.hpp"
#include "town.hpp"

namespace priormap {
namespace {

using test::pose;
using test::scan_from;

double position_error(const MappedScan& scan, const Eigen::Isometry3d& truth) { return (scan.T_map_sensor.translation() - truth.translation()).norm(); }

class Street : public testing::Test {
 protected:
  static constexpr int num_scans = 12;
  static Scan read_again(std::size_t k) { return scan_from(length_m, truth(static_cast<int>(k)), k); }
  static Eigen::Isometry3d truth(int k) { return pose(1.2 * k, 0.5 * std::sin(0.1 * k), 1.7, 0.02 * k); }
  static constexpr double length_m = 30;
  const std::vector<Eigen::Vector3d> world_ = test::street(length_m, 1);
};

TEST_F(Street, OdometryFollowsTheMotion) {
  Mapper mapper(MapperOptions::paper(), std::nullopt, {truth(0)}, 1);
  for (int k = 0; k < num_scans; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
  const auto scans = mapper.finish(read_again);
  ASSERT_EQ(scans.size(), static_cast<std::size_t>(num_scans));
  for (int k = 0; k < num_scans; ++k) EXPECT_LT(position_error(scans[static_cast<std::size_t>(k)], truth(k)), 0.15) << k;
  EXPECT_EQ(scans.back().verdict, Verdict::outside_prior);
}

TEST_F(Street, ThePriorCorrectsAWrongStartAndAnchorsTheDrive) {
  const test::TiledPoints tiles(world_, 50);
  const NearTiles prior(tiles, MapFrame::local(), 150);
  Mapper mapper(MapperOptions::paper(), prior, {pose(0.5, -0.4, 1.9, 0.03)}, 1);
  for (int k = 0; k < num_scans; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
  for (int k = 0; k < num_scans; ++k) {
    const MappedScan scan = mapper.finish(read_again)[static_cast<std::size_t>(k)];
    EXPECT_LT(position_error(scan, truth(k)), 0.15) << k;
    EXPECT_EQ(scan.verdict, Verdict::anchored);
    EXPECT_TRUE(scan.prior->accepted);
  }
}

TEST_F(Street, TheDefaultPresetFindsItsWayWithinCentimetres) {
  const test::TiledPoints tiles(world_, 50);
  const NearTiles prior(tiles, MapFrame::local(), 150);
  Mapper mapper(MapperOptions::preset("default"), prior, {pose(0.5, -0.4, 1.9, 0.03), pose(1.2, 0.05, 0, 0.02)}, 1);
  for (int k = 0; k < num_scans; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
  const auto scans = mapper.finish(read_again);
  for (int k = 0; k < num_scans; ++k) {
    EXPECT_LT(position_error(scans[static_cast<std::size_t>(k)], truth(k)), 0.1) << k;
    EXPECT_EQ(scans[static_cast<std::size_t>(k)].verdict, Verdict::anchored) << k;
    EXPECT_GT(scans[static_cast<std::size_t>(k)].covariance(3, 3), 0) << k;
  }
}

TEST_F(Street, ThePriorIsAskedEachFiveMetresUntilItHoldsTheDriveAndThenEachTwenty) {
  const test::TiledPoints tiles(world_, 50);
  const NearTiles prior(tiles, MapFrame::local(), 150);
  MapperOptions options = MapperOptions::preset("default");
  std::get<JointMethodOptions>(options.method).tracking.start_keyframes = 2;
  Mapper mapper(options, prior, {pose(0.5, -0.4, 1.9, 0.03), pose(1.2, 0.05, 0, 0.02)}, 1);
  for (int k = 0; k < 25; ++k) {
    const MappedScan scan = mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
    EXPECT_EQ(scan.prior.has_value(), k == 0 || k == 5 || k == 22) << k;   // 1.2 m a scan
    EXPECT_LT((scan.T_map_online.translation() - truth(k).translation()).norm(), 0.1) << k;
  }
}

/// Which is where a straight line from one place to the next tells nothing of the drift.
TEST_F(Street, ThePriorIsAskedOfAVehicleThatManoeuvresInPlaceToo) {
  const test::TiledPoints tiles(world_, 50);
  const NearTiles prior(tiles, MapFrame::local(), 150);
  MapperOptions options = MapperOptions::preset("default");
  std::get<JointMethodOptions>(options.method).tracking.start_keyframes = 2;
  const auto to_and_fro = [](int k) { return pose(4 + 3 * std::sin(0.3 * k), 0, 1.7, 0); };
  Mapper mapper(options, prior, {to_and_fro(0), to_and_fro(0).inverse() * to_and_fro(1)}, 1);
  int times_asked = 0;
  for (int k = 0; k < 50; ++k) times_asked += mapper.step(scan_from(length_m, to_and_fro(k), static_cast<std::size_t>(k))).prior.has_value();
  EXPECT_EQ(times_asked, 3);   // at the start, after 5 m and after 25 of 27 m
}

/// Ninety metres of the drive are missing, and the stamps tell of it: until it is found again in the prior nobody says that it is anchored, and then it is known back to the gap.
TEST_F(Street, ADriveIsFoundAgainInThePriorBeyondAGap) {
  constexpr int before = 12, beyond = 40;
  constexpr double long_m = 170, pause_s = 8;
  const test::TiledPoints tiles(test::street(long_m, 1), 50);
  const NearTiles prior(tiles, MapFrame::local(), 150);
  const auto T = [](int k) { return pose(1.2 * k + (k < before ? 0 : 90), 0.3 * std::sin(0.1 * k), 1.7, 0.01 * k); };
  const auto scan_at = [&](std::size_t k) {
    Scan scan = scan_from(long_m, T(static_cast<int>(k)), k);
    if (k >= before) scan.stamp_s += pause_s;
    return scan;
  };
  Mapper mapper(MapperOptions::preset("default"), prior, {T(0), pose(1.2, 0.03, 0, 0.01)}, 1);
  for (std::size_t k = 0; k < before + beyond; ++k) {
    const Verdict verdict = mapper.step(scan_at(k)).verdict;
    const bool may_be_anchored = k < before || k >= before + 10, must_be = k < before || k >= before + 25;
    EXPECT_GE(verdict == Verdict::anchored, must_be) << k;
    EXPECT_LE(verdict == Verdict::anchored, may_be_anchored) << k;
  }
  const auto scans = mapper.finish(scan_at);
  for (std::size_t k = 0; k < before + beyond; ++k) EXPECT_LT(position_error(scans[k], T(static_cast<int>(k))), 0.15) << k;
}

/// A quarter of houses that stand askew, with a street along x and one along y that cross at x = 40.
street::World quarter() {
  constexpr double street_m = 7;
  street::World world;
  world.add_ground(-150, -150, 200, 200);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0, 1);
  for (int i = -9; i < 12; ++i)
    for (int j = -9; j < 12; ++j) {
      const double x = 15 * i + 4 * part(random), y = 15 * j + 4 * part(random), length = 6 + 5 * part(random), width = 5 + 4 * part(random), yaw = 0.4 * part(random);
      const double half = 0.5 * std::hypot(length, width);
      if (std::abs(y) > street_m + half && std::abs(x - 40) > street_m + half) world.add_box(x, y, length, width, 8, yaw);
    }
  return world;
}

constexpr street::Laser coarse{.rings = 32, .columns = 700};

Scan scan_of(const street::World& world, const Eigen::Isometry3d& T_map_sensor, std::size_t index) {
  Scan scan;
  scan.index = index;
  scan.stamp_s = 0.1 * static_cast<double>(index);
  scan.points = street::scan(world, T_map_sensor, coarse, static_cast<unsigned>(index));
  return scan;
}

/// For forty scans a recording shows another street, and when its own is back, that is round a corner, 16 m from where the motion before would have led, at a right angle to it.
TEST_F(Street, ADriveIsFoundAgainRoundACornerBeyondScansOfElsewhere) {
  constexpr std::size_t before = 14, elsewhere = 40, after = 35, most_until_anchored = 30;
  const street::World own = quarter(), other = street::town(60, 3);
  const test::TiledPoints tiles(street::sample(own, 0.5, 0.1f), 50);
  const auto is_elsewhere = [](std::size_t k) { return k >= before && k < before + elsewhere; };
  const auto T = [](std::size_t k) {
    return k < before + elsewhere ? street::pose(-20 + 1.0 * static_cast<double>(k), 0.3, 1.7, 0) : street::pose(40.3, 15 + 0.8 * static_cast<double>(k - before - elsewhere), 1.7, 0.5 * std::numbers::pi);
  };
  const auto scan_at = [&](std::size_t k) { return scan_of(is_elsewhere(k) ? other : own, T(k), k); };
  Mapper mapper(MapperOptions::preset("default"), NearTiles(tiles, MapFrame::local(), 150), {T(0), T(0).inverse() * T(1)}, 1);
  for (std::size_t k = 0; k < before + elsewhere + after; ++k) {
    const Verdict verdict = mapper.step(scan_at(k)).verdict;
    const bool must_be_anchored = k < before || k >= before + elsewhere + most_until_anchored;
    EXPECT_GE(verdict == Verdict::anchored, must_be_anchored) << k;
    EXPECT_GE(verdict == Verdict::lost, is_elsewhere(k)) << k;
  }
  const auto scans = mapper.finish(scan_at);
  for (std::size_t k = 0; k < scans.size(); ++k)
    if (scans[k].verdict == Verdict::anchored) {
      EXPECT_LT(position_error(scans[k], T(k)), 0.15) << k;
    }
}

/// A drive along `quarter`, whose start the user puts 20 m off and facing the other way.
std::vector<MappedScan> drive_from_a_wrong_start(const street::World& prior) {
  constexpr std::size_t num_scans = 50;
  const street::World own = quarter();
  const test::TiledPoints tiles(street::sample(prior, 0.5, 0.1f), 50);
  const auto T = [](std::size_t k) { return street::pose(-20 + 1.0 * static_cast<double>(k), 0.3, 1.7, 0); };
  const auto scan_at = [&](std::size_t k) { return scan_of(own, T(k), k); };
  Mapper mapper(MapperOptions::preset("default"), NearTiles(tiles, MapFrame::local(), 150), {street::pose(-4, 12, 1.9, 2.9), T(0).inverse() * T(1)}, 1);
  for (std::size_t k = 0; k < num_scans; ++k) mapper.step(scan_at(k));
  std::vector<MappedScan> scans = mapper.finish(scan_at);
  for (MappedScan& scan : scans) scan.T_map_sensor = T(scan.index).inverse() * scan.T_map_sensor;   // its error
  return scans;
}

TEST_F(Street, AStartThatIsWrongByFarIsFound) {
  for (const MappedScan& scan : drive_from_a_wrong_start(quarter())) {
    EXPECT_EQ(scan.verdict, Verdict::anchored) << scan.index;
    EXPECT_LT(scan.T_map_sensor.translation().norm(), 0.15) << scan.index;
  }
}

/// The user is believed rather than a place that fits no better than others.
TEST_F(Street, AStartThatFitsNowhereStaysAsItIs) {
  const Eigen::Isometry3d error = drive_from_a_wrong_start(street::town(80, 3)).front().T_map_sensor;
  EXPECT_NEAR(error.translation().norm(), 20, 6);
  EXPECT_NEAR(Eigen::AngleAxisd(error.linear()).angle(), 2.9, 0.25);
}

TEST_F(Street, HeightsAreNoSurerThanPriorAndStartAgree) {
  const test::TiledPoints tiles(world_, 50);
  const NearTiles prior(tiles, MapFrame::local(), 150);
  const auto first_sigma_m = [&](double start_height_m, bool knows_height) {
    FirstPose first{pose(0.5, -0.4, start_height_m, 0.03), pose(1.2, 0.05, 0, 0.02)};
    first.knows_height = knows_height;
    Mapper mapper(MapperOptions::preset("default"), prior, first, 1);
    for (int k = 0; k < 5; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
    return std::sqrt(mapper.finish(read_again).front().covariance(5, 5));
  };
  const double height_m = truth(0).translation().z();
  EXPECT_LT(first_sigma_m(height_m + 0.5, false), 0.1);
  EXPECT_LT(first_sigma_m(height_m + 0.1, true), 0.1);
  EXPECT_GT(first_sigma_m(height_m + 0.5, true), 0.45);
}

/// What a spinning head sees that is driven on meanwhile: the time of a point follows from its azimuth.
Scan swept_from(double length_m, double k, const std::function<Eigen::Isometry3d(double)>& truth) {
  constexpr double period_s = 0.1;
  Scan scan = scan_from(length_m, truth(k), static_cast<std::size_t>(k));
  for (Eigen::Vector3f& p : scan.points.xyz) {
    const double turn = -std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x())) / (2 * std::numbers::pi);
    scan.points.time_s.push_back(static_cast<float>(period_s * turn));
    p = (truth(k + turn).inverse() * truth(k) * p.cast<double>()).cast<float>();
  }
  return scan;
}

TEST_F(Street, TheMotionWithinASweepIsUndone) {
  const auto fast = [](double k) { return pose(1.8 * k, 0.5 * std::sin(0.3 * k), 1.7, 0.1 * std::sin(0.5 * k)); };
  const auto scan = [&](std::size_t k) { return swept_from(length_m, static_cast<double>(k), fast); };
  const auto greatest_error = [&](bool timed) {
    Mapper mapper(MapperOptions::preset("default"), std::nullopt, {fast(0), fast(0).inverse() * fast(1)}, 1);
    const auto read = [&](std::size_t k) {
      Scan one = scan(k);
      if (!timed) one.points.time_s.clear();
      return one;
    };
    for (std::size_t k = 0; k < num_scans; ++k) mapper.step(read(k));
    double greatest = 0;
    for (const MappedScan& one : mapper.finish(read)) greatest = std::max(greatest, position_error(one, fast(static_cast<double>(one.index))));
    return greatest;
  };
  EXPECT_LT(greatest_error(true), 0.1);
  EXPECT_GT(greatest_error(false), 2 * greatest_error(true));
}

TEST_F(Street, TheDefaultPresetNeedsNoPriorForOdometry) {
  Mapper mapper(MapperOptions::preset("default"), std::nullopt, {truth(0), truth(0).inverse() * truth(1)}, 1);
  for (int k = 0; k < num_scans; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
  const auto scans = mapper.finish(read_again);
  for (int k = 0; k < num_scans; ++k) EXPECT_LT(position_error(scans[static_cast<std::size_t>(k)], truth(k)), 0.05) << k;
  EXPECT_EQ(scans.back().verdict, Verdict::outside_prior);
  EXPECT_GT(scans.back().covariance(3, 3), scans.front().covariance(3, 3));
}

/// A gap in the recording: the old street never comes back, and the drive must not stay lost for ever.
TEST_F(Street, ADriveThatIsNeverFoundAgainBeginsAnew) {
  Mapper mapper(MapperOptions::preset("default"), std::nullopt, {truth(0), truth(0).inverse() * truth(1)}, 1);
  for (int k = 0; k < num_scans; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
  Scan empty;
  for (std::size_t k = 0; k < 100; ++k) EXPECT_EQ(mapper.step(empty).verdict, Verdict::lost);
  const Scan there = scan_from(length_m, truth(2), 2);
  mapper.step(there);
  EXPECT_NE(mapper.step(there).verdict, Verdict::lost);
  const auto scans = mapper.finish(read_again);
  EXPECT_GT(scans.back().covariance(3, 3), 1000);   // and says that it does not know where
}

/// Some scans were never written, and the stamps do not tell.
TEST_F(Street, ScansThatAreMissingAreDrivenOver) {
  constexpr double long_m = 60;
  Mapper mapper(MapperOptions::preset("default"), std::nullopt, {truth(0), truth(0).inverse() * truth(1)}, 1);
  const auto scan = [&](std::size_t i) {
    Scan one = scan_from(long_m, truth(static_cast<int>(i < 10 ? i : i + 6)), i);
    one.stamp_s = 0.1 * static_cast<double>(i);
    return one;
  };
  for (std::size_t i = 0; i < 16; ++i) mapper.step(scan(i));
  for (const MappedScan& one : mapper.finish(scan)) EXPECT_LT(position_error(one, truth(static_cast<int>(one.index < 10 ? one.index : one.index + 6))), 0.1) << one.index;
}

/// A platform that rocks turns back when constant velocity says it turns on.
TEST_F(Street, ARockingPlatformIsFollowed) {
  const auto rocking = [](int k) {
    Eigen::Isometry3d T = pose(0.3 * k, 0, 1.7, 0);
    T.linear() = Eigen::AngleAxisd(0.06 * (k % 2 ? 1 : -1), Eigen::Vector3d::UnitY()).toRotationMatrix();
    return T;
  };
  Mapper mapper(MapperOptions::preset("default"), std::nullopt, {rocking(0), rocking(0).inverse() * rocking(1)}, 1);
  for (int k = 0; k < num_scans; ++k) mapper.step(scan_from(length_m, rocking(k), static_cast<std::size_t>(k)));
  const auto scans = mapper.finish([&](std::size_t k) { return scan_from(length_m, rocking(static_cast<int>(k)), k); });
  for (int k = 0; k < num_scans; ++k) {
    EXPECT_LT(position_error(scans[static_cast<std::size_t>(k)], rocking(k)), 0.06) << k;
    EXPECT_LT(Eigen::AngleAxisd(scans[static_cast<std::size_t>(k)].T_map_sensor.linear().transpose() * rocking(k).linear()).angle(), 0.01) << k;
  }
}

TEST_F(Street, SigmasGrowWithoutAPriorAndNotWithOne) {
  const test::TiledPoints tiles(world_, 50);
  const NearTiles prior(tiles, MapFrame::local(), 150);
  Mapper anchored(MapperOptions::paper(), prior, {truth(0)}, 1), drifting(MapperOptions::paper(), std::nullopt, {truth(0)}, 1);
  for (int k = 0; k < 12; ++k) {
    const Scan scan = scan_from(length_m, truth(k), static_cast<std::size_t>(k));
    anchored.step(scan);
    drifting.step(scan);
  }
  const auto with = anchored.finish(read_again), without = drifting.finish(read_again);
  EXPECT_GT(without[11].covariance(3, 3), 2 * without[3].covariance(3, 3));
  EXPECT_LT(with[11].covariance(3, 3), 2 * with[3].covariance(3, 3));
}

TEST_F(Street, AVehicleThatStandsRepeatsItsPose) {
  Mapper mapper(MapperOptions::paper(), std::nullopt, {truth(0)}, 1);
  for (int k = 0; k < 5; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
  for (int k = 5; k < 9; ++k) mapper.step(scan_from(length_m, truth(4), static_cast<std::size_t>(k)));
  const auto scans = mapper.finish(read_again);
  for (std::size_t k = 5; k < 9; ++k) {
    EXPECT_TRUE(scans[k].standstill);
    EXPECT_TRUE(scans[k].T_map_sensor.isApprox(scans[4].T_map_sensor));
  }
}

TEST_F(Street, CreepingAddsUpUntilItIsSeen) {
  Mapper mapper(MapperOptions::paper(), std::nullopt, {pose(0, 0, 1.7, 0)}, 1);
  for (int k = 0; k < 20; ++k) mapper.step(scan_from(length_m, pose(0.04 * k, 0, 1.7, 0), static_cast<std::size_t>(k)));
  const auto scans = mapper.finish(read_again);
  EXPECT_TRUE(scans[1].standstill);
  EXPECT_NEAR(scans.back().T_map_sensor.translation().x(), 0.76, 0.15);
}

TEST_F(Street, WhereThePriorEndsTheDriveGoesOn) {
  auto half = world_;
  std::erase_if(half, [](const Eigen::Vector3d& p) { return p.x() > -28; });
  const test::TiledPoints tiles(half, 50);
  const NearTiles prior(tiles, MapFrame::local(), 150);
  Mapper mapper(MapperOptions::paper(), prior, {truth(0)}, 1);
  for (int k = 0; k < num_scans; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
  const auto scans = mapper.finish(read_again);
  EXPECT_EQ(scans.back().verdict, Verdict::outside_prior);
  EXPECT_LT(position_error(scans.back(), truth(num_scans - 1)), 1.0);  // the rim of the prior pulls: 6 m correspondences have no other partner
}

TEST_F(Street, WhereThePriorNeverBeginsPosesAreAsSureAsTheStart) {
  const test::TiledPoints tiles(world_, 50);
  const Eigen::Isometry3d away(Eigen::Translation3d(0, 500, 0));
  for (const char* preset : {"default", "paper"}) {
    const NearTiles prior(tiles, MapFrame::local(), 150);
    Mapper mapper(MapperOptions::preset(preset), prior, {away * truth(0)}, 1);
    for (int k = 0; k < 6; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
    for (const MappedScan& scan : mapper.finish(read_again)) {
      EXPECT_EQ(scan.verdict, Verdict::outside_prior) << preset;
      const Eigen::Matrix3d position = scan.T_map_sensor.linear() * scan.covariance.bottomRightCorner<3, 3>() * scan.T_map_sensor.linear().transpose();
      EXPECT_GT(std::sqrt(position(0, 0)), 4.9) << preset;
      EXPECT_GT(std::sqrt(position(2, 2)), 0.9) << preset;
      EXPECT_GT(std::sqrt(scan.covariance(2, 2)), 0.19) << preset;
      if (scan.index == 0) { EXPECT_LT(std::sqrt(position(0, 0)), 5.1) << preset; }
    }
  }
}

TEST_F(Street, AScanWithoutPointsCarriesTheMotionOn) {
  Mapper mapper(MapperOptions::paper(), std::nullopt, {truth(0)}, 1);
  for (int k = 0; k < 10; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
  Scan empty;
  empty.index = 10;
  EXPECT_EQ(mapper.step(empty).verdict, Verdict::lost);
  mapper.step(scan_from(length_m, truth(11), 11));
  const auto scans = mapper.finish(read_again);
  EXPECT_LT(position_error(scans[10], truth(10)), 0.3);
  EXPECT_LT(position_error(scans[11], truth(11)), 0.2);
}

TEST_F(Street, ThreadsDoNotChangeTheResult) {
  const test::TiledPoints tiles(world_, 50);
  std::vector<std::vector<MappedScan>> runs;
  for (const int threads : {1, 3}) {
    const NearTiles prior(tiles, MapFrame::local(), 150);
    Mapper mapper(MapperOptions::paper(), prior, {truth(0)}, threads);
    for (int k = 0; k < 6; ++k) mapper.step(scan_from(length_m, truth(k), static_cast<std::size_t>(k)));
    runs.push_back(mapper.finish(read_again));
  }
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(runs[0][k].T_map_sensor.matrix(), runs[1][k].T_map_sensor.matrix());
}

/// The scan as a head sees it that spins once in 0.1 s while the sensor moves at `velocity`: each point with its time, seen from where the sensor is then.
Scan swept(Scan scan, const Vector6d& velocity) {
  for (Eigen::Vector3f& p : scan.points.xyz) {
    scan.points.time_s.push_back(static_cast<float>(-std::atan2(p.y(), p.x()) * 0.05 / std::numbers::pi));
    p = (moved_on(Eigen::Isometry3d::Identity(), velocity, scan.points.time_s.back()).inverse() * p.cast<double>()).cast<float>();
  }
  return scan;
}

/// Cut off after any scan and gone on with in a mapper of its own, a drive ends as if it had not been.
TEST_F(Street, AMapperGoesOnFromItsState) {
  const test::TiledPoints tiles(world_, 10);
  const NearTiles prior(tiles, MapFrame::local(), 20);   // tiles come and go
  std::vector<Scan> drive;
  for (int k = 0; k < num_scans; ++k) drive.push_back(swept(scan_from(length_m, truth(k), static_cast<std::size_t>(k)), steady_velocity(truth(k), truth(k + 1), 0.1)));
  const auto read = [&](std::size_t k) { return drive[k]; };
  for (const char* preset : {"default", "paper"}) {
    for (const auto& with : {std::optional<NearTiles>(prior), std::optional<NearTiles>()}) {
      const auto begin = [&] { return Mapper(MapperOptions::preset(preset), with, {pose(0.3, -0.2, 1.8, 0.02), truth(0).inverse() * truth(1)}, 1); };
      const auto drive_on = [&](Mapper& mapper, int first, int last) {
        for (int k = first; k < last; ++k) mapper.step(drive[static_cast<std::size_t>(k)]);
      };
      Mapper whole = begin();
      drive_on(whole, 0, num_scans);
      const auto expected = whole.finish(read);
      EXPECT_EQ(expected[4].motion_undone, preset == std::string("default"));
      for (const int cut : {1, 5, num_scans}) {
        Mapper half = begin(), rest = begin();
        drive_on(half, 0, cut);
        StateArchive out;
        half.exchange(out);
        StateArchive in(out.take());
        rest.exchange(in);
        in.expect_end();
        EXPECT_EQ(rest.num_scans(), static_cast<std::size_t>(cut));
        drive_on(rest, cut, num_scans);
        const auto scans = rest.finish(read);
        ASSERT_EQ(scans.size(), expected.size());
        for (std::size_t k = 0; k < scans.size(); ++k) {
          EXPECT_EQ(scans[k].T_map_sensor.matrix(), expected[k].T_map_sensor.matrix()) << preset << ", cut " << cut << ", scan " << k;
          EXPECT_EQ(scans[k].T_map_online.matrix(), expected[k].T_map_online.matrix());
          EXPECT_EQ(scans[k].covariance, expected[k].covariance);
          EXPECT_EQ(scans[k].verdict, expected[k].verdict);
          EXPECT_EQ(scans[k].velocity, expected[k].velocity);
          EXPECT_EQ(scans[k].motion_undone, expected[k].motion_undone);
        }
      }
    }
  }
}

}  // namespace
}  // namespace priormap
