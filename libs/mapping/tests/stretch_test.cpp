#include <gtest/gtest.h>

#include "stretch.hpp"
#include "town.hpp"

namespace priormap {
namespace {

TEST(Stretches, CoverADriveOnceAndBeginEarly) {
  for (const std::size_t count : {1u, 249u, 250u, 499u, 500u, 1000u, 4541u}) {
    const auto stretches = stretches_of(7, 7 + count, {.scans = 250, .overlap = 40});
    EXPECT_EQ(stretches.front().begin, 7u);
    EXPECT_EQ(stretches.back().last, 7 + count);
    std::size_t next = 7;
    for (const Stretch& stretch : stretches) {
      EXPECT_EQ(stretch.first, next);
      EXPECT_EQ(stretch.first - stretch.begin, next == 7 ? 0u : 40u);
      if (count >= 250) {
        EXPECT_GE(stretch.last - stretch.first, 250u);
        EXPECT_LT(stretch.last - stretch.first, 500u);
      }
      next = stretch.last;
    }
  }
}

/// Shared scans of two odometries, the second in a frame of its own, each pose off by up to `noise_m`.
struct Overlap {
  std::vector<ScanRecord> before;
  std::vector<DrivenScan> shared;
  explicit Overlap(const Eigen::Isometry3d& T_odom_stretch, double noise_m) {
    for (int k = 0; k < 20; ++k) {
      const Eigen::Isometry3d T = test::pose(100 + 1.1 * k, 50 + 0.1 * k, 1, 0.3 + 0.02 * k);
      ScanRecord record{};
      record.odometry.T_odom_sensor = T * Eigen::Translation3d(noise_m * std::sin(7.0 * k), noise_m * std::cos(5.0 * k), 0);
      record.odometry.joined = true;
      before.push_back(record);
      DrivenScan scan;
      scan.step.T_odom_sensor = T_odom_stretch.inverse() * T;
      scan.step.joined = true;
      shared.push_back(scan);
    }
  }
};

TEST(Stretches, AreJoinedByTheScansThatTwoDrove) {
  const Eigen::Isometry3d T = test::pose(80, 45, 0.5, 0.4);
  const Overlap exact(T, 0);
  const auto joined = T_odom_stretch(exact.before, exact.shared);
  ASSERT_TRUE(joined);
  EXPECT_TRUE(joined->isApprox(T, 1e-12));
  const Overlap noisy(T, 0.01);
  EXPECT_LT((*T_odom_stretch(noisy.before, noisy.shared) * noisy.shared.back().step.T_odom_sensor.translation() - exact.before.back().odometry.T_odom_sensor.translation()).norm(), 0.006);
}

TEST(Stretches, AreNotJoinedWhereTheyDisagreeOrEitherWasLost) {
  const Eigen::Isometry3d T = test::pose(80, 45, 0.5, 0.4);
  const Overlap apart(T, 0.5);
  EXPECT_FALSE(T_odom_stretch(apart.before, apart.shared));
  Overlap lost_before(T, 0), lost_after(T, 0), shrunk(T, 0);
  lost_before.before.back().odometry.joined = false;
  lost_after.shared[15].step.joined = false;
  shrunk.shared.resize(5);
  EXPECT_FALSE(T_odom_stretch(lost_before.before, lost_before.shared));
  EXPECT_FALSE(T_odom_stretch(lost_after.before, lost_after.shared));
  EXPECT_FALSE(T_odom_stretch(shrunk.before, shrunk.shared));
}

}  // namespace
}  // namespace priormap
