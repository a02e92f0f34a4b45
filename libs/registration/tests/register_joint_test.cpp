#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <priormap/registration/observability.hpp>
#include <priormap/registration/register_joint.hpp>
#include <priormap/registration/scan_reducer.hpp>
#include <random>

#include "street.hpp"

using namespace priormap;

namespace {

const Eigen::Vector3d far_origin(21000, -9000, 116);

/// A scan within a town and the prior of that town.
class JointRegistrationTest : public testing::Test {
 protected:
  const street::World world = street::town(100, 3, far_origin);
  const Eigen::Isometry3d truth = street::pose(far_origin.x() + 50, far_origin.y() + 1, far_origin.z() + 1.8, 0.1);
  SurfelMap prior;
  JointRegistration registration;
  void SetUp() override { prior.insert(street::sample(world, 0.5, 0.0f)); }
  SurfelCloud scan(double noise_m) const { return ScanReducer(1.0).reduce(street::scan(world, truth, {.noise_m = noise_m}, 1)); }
};

TEST_F(JointRegistrationTest, FindsThePoseWithinAMillimetreWithoutNoise) {
  const JointTarget target{&prior};
  for (const auto& off : {street::pose(0.5, 0.3, 0.1, 0.035), street::pose(-0.4, -0.5, -0.2, -0.035)}) {
    const JointResult result = registration.align(scan(0), {&target, 1}, truth * off);
    EXPECT_TRUE(result.converged);
    EXPECT_LT(street::distance(result.T_map_scan, truth), 1e-3);
    EXPECT_LT(street::angle(result.T_map_scan, truth), 1e-4);
    EXPECT_GT(result.targets[0].inlier_share(), 0.99);
  }
}

TEST_F(JointRegistrationTest, FindsThePoseFromFiveMetresAndTenDegreesOff) {
  const JointTarget target{&prior};
  const SurfelCloud noisy = scan(0.02);
  for (const auto& off : {street::pose(4, 3, 0.3, 0.175), street::pose(-4.9, 1, -0.3, -0.175), street::pose(0, -5, 0, 0.175)}) {
    const JointResult result = registration.search(noisy, {&target, 1}, truth * off).front().match;
    EXPECT_TRUE(result.converged);
    EXPECT_LT(street::distance(result.T_map_scan, truth), 0.01);
    EXPECT_LT(street::angle(result.T_map_scan, truth), 5e-4);
  }
}

TEST_F(JointRegistrationTest, AllInstructionSetsGiveTheSameBytes) {
  const JointTarget target{&prior};
  const SurfelCloud noisy = scan(0.02);
  const JointResult portable = JointRegistration({}, InstructionSet::portable).align(noisy, {&target, 1}, truth * street::pose(0.2, 0.1, 0, 0.01));
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512, InstructionSet::best}) {
    if (!is_available(set)) continue;
    const JointResult other = JointRegistration({}, set).align(noisy, {&target, 1}, truth * street::pose(0.2, 0.1, 0, 0.01));
    EXPECT_EQ(portable.T_map_scan.matrix(), other.T_map_scan.matrix());
    EXPECT_EQ(portable.information, other.information);
  }
}

TEST_F(JointRegistrationTest, PointsWithoutNormalsHoldTheScanToo) {
  PointCloud bare = street::sample(world, 0.8, 0.05f);
  bare.normal.clear();
  SurfelMap map;
  map.insert(bare);
  const JointTarget target{&map};
  const JointResult result = registration.align(scan(0.02), {&target, 1}, truth * street::pose(0.4, 0.2, 0.2, 0.02));
  EXPECT_LT(street::distance(result.T_map_scan, truth), 0.1);
}

/// Where nothing has moved, the rings of the lasers lie on those of the scan before: that must not bind the scan.
TEST(JointRegistrationOfRings, OfTheScanBeforeHideNoMotion) {
  const street::World world = street::wide_street();
  const Eigen::Isometry3d before = street::pose(0, 0, 1.2, 0);
  Eigen::Isometry3d after = street::pose(0.4, 0.1, 1.2, 0.01);
  after.linear() = after.linear() * exp_so3({-0.03, 0.04, 0}).toRotationMatrix();
  SurfelMap map;
  map.insert(ScanReducer(1.0).reduce(street::scan(world, before, street::hdl32, 1)), before);
  const SurfelCloud scan = ScanReducer(1.0).reduce(street::scan(world, after, street::hdl32, 2));
  const JointTarget target{&map};
  const Eigen::Isometry3d found = JointRegistration().align(scan, {&target, 1}, before).T_map_scan;
  EXPECT_LT(street::angle(found, after), 0.01);
  EXPECT_LT(street::distance(found, after), 0.05);
}

TEST(JointRegistrationInACanyon, TheInformationSaysThatAlongTheStreetNothingIsKnown) {
  const street::World world = street::canyon();
  SurfelMap prior;
  prior.insert(street::sample(world, 0.5, 0.05f));
  const Eigen::Isometry3d truth = street::pose(10, 1, 1.8, 0);
  const SurfelCloud scan = ScanReducer(1.0).reduce(street::scan(world, truth, {}, 1));
  const JointTarget target{&prior};
  const JointResult result = JointRegistration().align(scan, {&target, 1}, truth * street::pose(0, 0.3, 0.1, 0.01));
  EXPECT_LT((result.T_map_scan.translation() - truth.translation()).tail<2>().norm(), 0.01);
  const Observability o = observability(result.targets[0].information);
  EXPECT_GT(o.translation_sigma_m[0], 100 * o.translation_sigma_m[1]);
  EXPECT_GT(std::abs(o.translation_axes(0, 0)), 0.99);  // the sensor looks along the street
}

/// A wall's traces above the ground are nearer to that than to what an outline knows of the wall; they are many, and the ground shows little.
TEST(JointRegistrationOfNormals, WhatFacesElsewhereDoesNotLieOnTheNearestPlane) {
  PointCloud ground;
  SurfelCloud scan;
  for (int x = -10; x < 10; ++x)
    for (int y = -3; y < 3; ++y) {
      const Eigen::Vector3f p(float(x) + 0.5f, float(y) + 0.5f, 0.5f), above = p + Eigen::Vector3f(0, 0, 0.6f);
      ground.xyz.push_back(p);
      ground.normal.push_back(Eigen::Vector3f::UnitZ());
      const bool street = std::abs(y) < 2;
      if (street && x % 4 == 0) scan.surfels.push_back({.mean = p, .count = 20}), scan.normals.push_back(Eigen::Vector3f::UnitZ());
      if (!street) scan.surfels.push_back({.mean = above, .count = 20}), scan.normals.push_back(Eigen::Vector3f::UnitY());
    }
  SurfelMap prior;
  prior.insert(ground);
  const JointTarget target{&prior};
  const Eigen::Isometry3d truth = Eigen::Isometry3d::Identity(), guess = street::pose(0, 0, 0.1, 0);
  const auto height_m = [&] { return JointRegistration().align(scan, {&target, 1}, guess).T_map_scan.translation().z(); };
  EXPECT_NEAR(height_m(), truth.translation().z(), 1e-3);
  scan.normals.clear();
  EXPECT_LT(height_m(), -0.1);   // pulled down to them
}

TEST_F(JointRegistrationTest, WhereTheWordOfNormalsIsWrittenNothingIsLost) {
  SurfelCloud noisy = scan(0.02);
  tell_normals(noisy, 1.0);
  const JointTarget target{&prior};
  const JointResult result = registration.align(noisy, {&target, 1}, truth * street::pose(0.4, 0.2, 0.1, 0.02));
  EXPECT_LT(street::distance(result.T_map_scan, truth), 0.01);
  EXPECT_GT(double(result.targets[0].num_correspondences), 0.9 * double(noisy.size()));
}

/// A room's surfels hold it on all sides: which direction they tell least of changes with each step, which must end.
TEST(JointRegistrationInARoom, EndsWhereNoDirectionIsTheWeakest) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 0.08f);
  PointCloud planes;
  SurfelCloud scan;
  const auto add = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& normal) {
    planes.xyz.push_back(p);
    planes.normal.push_back(normal);
    scan.surfels.push_back({.mean = p + noise(random) * normal, .count = 20});
  };
  for (int a = -3; a < 3; ++a)
    for (int b = -3; b < 3; ++b)
      for (const float side : {-3.5f, 3.5f})
        for (int axis = 0; axis < 3; ++axis) {
          Eigen::Vector3f p;
          p[axis] = side, p[(axis + 1) % 3] = float(a) + 0.5f, p[(axis + 2) % 3] = float(b) + 0.5f;
          add(p, Eigen::Vector3f::Unit(axis));
        }
  scan.few_lasers = true;
  SurfelMap map;
  map.insert(planes);
  const JointTarget target{&map};
  for (const double off_m : {0.0, 0.05, 0.1, 0.2}) EXPECT_TRUE(JointRegistration().align(scan, {&target, 1}, street::pose(off_m, -off_m, 0, off_m / 10)).converged) << off_m;
}

/// Two scans of few lasers, the first of which is the map; little but piers tells how far the sensor went between them.
class JointRegistrationOfFewLasers : public testing::Test {
 protected:
  const street::World world = street::canyon_with_piers();
  const Eigen::Isometry3d rest = Eigen::Isometry3d::Identity();
  SurfelCloud scan_at(double x, unsigned seed) const { return ScanReducer(1.0).reduce(street::scan(world, street::pose(x, 0.3, 1.7, 0), street::vlp16, seed)); }
  Eigen::Isometry3d motion_found(double x, double way_m, const std::optional<Eigen::Isometry3d>& against) const {
    SurfelMap map;
    map.insert(scan_at(x, 1), rest);
    const JointTarget target{&map};
    const PoseSearchOptions around_rest{.radius_m = 4, .yaw_rad = 0.1, .step_m = 0.5};
    return JointRegistration().search(scan_at(x + way_m, 2), {&target, 1}, rest, around_rest, against).front().match.T_map_scan;
  }
};

TEST_F(JointRegistrationOfFewLasers, FindsAMotionByWhatSpeaksForItRatherThanForRest) {
  for (const auto& [x, way_m] : {std::pair(0.0, 1.0), {10.0, 1.5}, {10.0, 2.0}, {0.0, 2.0}, {55.0, 2.5}})
    EXPECT_LT(street::distance(motion_found(x, way_m, rest), street::pose(way_m, 0, 0, 0)), 0.03) << x << ' ' << way_m;
}

TEST_F(JointRegistrationOfFewLasers, FindsThatASensorStoodStill) {
  for (const double x : {0.0, 10.0, 55.0}) EXPECT_LT(street::distance(motion_found(x, 0, rest), rest), 0.005) << x;
}

/// What fits anywhere along the street outvotes the piers where all count alike.
TEST_F(JointRegistrationOfFewLasers, HowManySurfelsFitDoesNotTellAMotion) {
  for (const double x : {0.0, 10.0}) EXPECT_GT(street::distance(motion_found(x, 2, std::nullopt), street::pose(2, 0, 0, 0)), 0.5) << x;
}

/// Surfels of a street along x and the planes that they meet, one a voxel. Thousands lie along it, on planes known to a degree, and fit exactly where the sensor is thought to be, 8 cm short;
/// `num_crosswise` tell better, and scatter; a share of them has been moved by 0.4 m since.
struct StreetOfSurfels {
  PointCloud planes;
  SurfelCloud scan;   // taken at T_map_scan
  const Eigen::Isometry3d T_map_scan = street::pose(0.08, 0, 0, 0);
  std::mt19937 random{1};

  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, const Eigen::Vector3d& p_scan) {
    planes.xyz.push_back(p.cast<float>());
    planes.normal.push_back(normal.normalized().cast<float>());
    planes.sigma_m.push_back(0);
    scan.surfels.push_back({.mean = p_scan.cast<float>(), .count = 100});
  }
  StreetOfSurfels(int num_crosswise, double scatter_m, double share_moved = 0) {
    std::normal_distribution<double> tilt(0, 0.02);
    for (int x = -50; x < 50; ++x)
      for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3d ground(x + 0.5, i - 9.5, -1.5), wall(x + 0.5, i % 2 ? 10.5 : -10.5, i / 2 + 0.5);
        add(ground, {tilt(random), 0, 1}, ground);
        add(wall, {tilt(random), 1, 0}, wall);
      }
    for (int i = 0; i < num_crosswise; ++i) {
      const Eigen::Vector3d p(3 * (i % 30) - 44.5, i % 2 ? 8.5 : -8.5, i / 30 + 1.5);
      const double off_m = i < share_moved * num_crosswise ? 0.4 : scatter_m * (2 * (i * 7 % num_crosswise + 0.5) / num_crosswise - 1);
      add(p, Eigen::Vector3d::UnitX(), T_map_scan.inverse() * p + off_m * Eigen::Vector3d::UnitX());
    }
    scan.few_lasers = true;
  }
  /// By a registration that begins where all but the crosswise surfels fit exactly.
  JointResult registered() const {
    SurfelMap map;
    map.insert(planes);
    const JointTarget target{&map};
    const JointResult result = JointRegistration().align(scan, {&target, 1}, Eigen::Isometry3d::Identity());
    EXPECT_TRUE(result.converged);
    return result;
  }
  /// How far along the street that errs.
  double error_m() const { return (registered().T_map_scan.translation() - T_map_scan.translation()).x(); }
};

TEST(JointRegistrationAlongAStreet, TheFewThatTellOfItAreNoOutliersAmongTheManyThatDoNot) {
  for (const double scatter_m : {0.05, 0.1, 0.15}) EXPECT_LT(std::abs(StreetOfSurfels(30, scatter_m).error_m()), 0.01) << scatter_m;
}

/// The mean of n that scatter evenly by up to s is known to s / sqrt(3 n), however surely the thousands fit that tell of other directions.
TEST(JointRegistrationAlongAStreet, IsKnownAsSurelyAsThoseScatterThatTellOfIt) {
  constexpr int num_crosswise = 30;
  for (const double scatter_m : {0.15, 0.3}) {
    const Matrix6d information = StreetOfSurfels(num_crosswise, scatter_m).registered().targets[0].information;
    EXPECT_LT(information(3, 3), 2 * 3 * num_crosswise / (scatter_m * scatter_m)) << scatter_m;
    EXPECT_GT(information(4, 4), 1e5) << scatter_m;   // across it as before
  }
}

/// Walls seen slantwise by few columns of points are no poles: those would travel with the sensor.
TEST(JointRegistrationAlongAStreet, AScanOfFewColumnsStaysWhereItIs) {
  const street::World world = street::canyon_with_piers();
  const auto scan_at = [&](double x, unsigned seed) { return ScanReducer(1.0).reduce(street::scan(world, street::pose(x, 0.3, 1.7, 0), street::Laser{}, seed)); };
  for (const double x : {0.0, 10.0, 30.0})
    for (const double way_m : {0.5, 1.0, 1.4}) {
      SurfelMap map;
      map.insert(scan_at(x, 1), Eigen::Isometry3d::Identity());
      const JointTarget target{&map};
      const Eigen::Isometry3d truth = street::pose(way_m, 0, 0, 0);
      EXPECT_LT(street::distance(JointRegistration().align(scan_at(x + way_m, 2), {&target, 1}, truth).T_map_scan, truth), 0.03) << x << ' ' << way_m;
    }
}

TEST(JointRegistrationAlongAStreet, WhereMostOfThemAgreeTheRestAreOutliers) {
  for (const double share_moved : {0.1, 0.3}) EXPECT_LT(std::abs(StreetOfSurfels(60, 0.02, share_moved).error_m()), 0.005) << share_moved;
}

}  // namespace
