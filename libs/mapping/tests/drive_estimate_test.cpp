#include <gtest/gtest.h>

#include <Eigen/LU>

#include "drive_estimate.hpp"

namespace priormap {
namespace {

Eigen::Isometry3d at(double x) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().x() = x;
  return T;
}

/// A metre a scan; scans 10 to 13 lost, and 14 as well, where the local map begins anew.
std::vector<ScanRecord> drive_with_a_gap() {
  std::vector<ScanRecord> records;
  for (std::size_t i = 0; i < 30; ++i) {
    OdometryStep step;
    step.T_odom_sensor = at(static_cast<double>(i));
    step.joined = i > 0 && (i < 10 || i > 14);
    step.began_anew = i == 14;
    step.num_followed = i == 14 ? 4 : 0;
    step.information = step.joined ? Matrix6d(1e4 * Matrix6d::Identity()) : Matrix6d::Zero();
    step.figures.converged = step.joined;
    records.push_back({i, 0.1 * static_cast<double>(i), step, step.T_odom_sensor});
  }
  return records;
}

TEST(DriveEstimate, AcrossAGapNobodyIsSure) {
  const auto poses = estimate_drive(drive_with_a_gap(), std::nullopt, {}, {});
  ASSERT_EQ(poses.size(), 30u);
  const auto sigma_m = [&](std::size_t i) { return std::sqrt(poses[i].covariance(3, 3)); };
  EXPECT_LT(sigma_m(9), 0.5);
  EXPECT_GT(sigma_m(10), 50) << "followed apart, they belong to what comes";
  EXPECT_GT(sigma_m(15), 50);
  EXPECT_GT(sigma_m(29), 50);
}

TEST(DriveEstimate, ScansLostBeforeAGapStayWithWhatCameBefore) {
  std::vector<ScanRecord> records = drive_with_a_gap();
  records[14].odometry.num_followed = 1;
  for (std::size_t i = 13; i < records.size(); ++i) records[i].T_map_online.translation().x() += 1000;   // found there in the prior
  const auto poses = estimate_drive(records, std::nullopt, {}, {});
  for (std::size_t i = 10; i < 13; ++i) {
    EXPECT_NEAR(poses[i].T_map_sensor.translation().x(), static_cast<double>(i), 0.1);
    EXPECT_LT(poses[i].covariance(3, 3), 5 * 5);
  }
  EXPECT_GT(poses[13].covariance(3, 3), 50 * 50);
}

TEST(DriveEstimate, TheLongerLostAtTheEndTheLessSure) {
  std::vector<ScanRecord> records = drive_with_a_gap();
  records.resize(14);
  const auto poses = estimate_drive(records, std::nullopt, {}, {});
  const auto sigma_m = [&](std::size_t i) { return std::sqrt(poses[i].covariance(3, 3)); };
  EXPECT_LT(sigma_m(9), 0.5);
  EXPECT_GT(sigma_m(10), 0.4);
  EXPECT_GT(sigma_m(13), 3.5 * sigma_m(10));
}

TEST(DriveEstimate, ADriveThatIsFoundAgainIsKnownBackToTheGap) {
  std::vector<ScanRecord> records = drive_with_a_gap();
  for (std::size_t i = 14; i < 20; ++i) records[i].located = false;
  for (const EstimatedPose& pose : estimate_drive(records, std::nullopt, {}, {})) EXPECT_FALSE(pose.contradicted);
}

TEST(DriveEstimate, ADriveThatIsNotFoundAgainIsNotAnchored) {
  std::vector<ScanRecord> records = drive_with_a_gap();
  for (std::size_t i = 14; i < records.size(); ++i) records[i].located = false;
  const auto poses = estimate_drive(records, std::nullopt, {}, {});
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(poses[i].contradicted, i >= 10) << i;
}

TEST(DriveEstimate, WithoutAPriorNoHeightIsDoubted) {
  const auto poses = estimate_drive(drive_with_a_gap(), std::nullopt, {}, {}, 5.0);
  EXPECT_EQ(poses.front().covariance(5, 5), estimate_drive(drive_with_a_gap(), std::nullopt, {}, {}).front().covariance(5, 5));
}

TEST(DriveEstimate, WithoutAPriorTheOdometryStays) {
  const auto poses = estimate_drive(drive_with_a_gap(), std::nullopt, {}, {});
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_NEAR(poses[i].T_map_sensor.translation().x(), static_cast<double>(i), 1e-6) << i;
}

}  // namespace
}  // namespace priormap
