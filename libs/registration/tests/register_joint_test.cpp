#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <priormap/registration/observability.hpp>
#include <priormap/registration/register_joint.hpp>
#include <priormap/registration/scan_reducer.hpp>

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

}  // namespace
