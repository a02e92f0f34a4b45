#include <gtest/gtest.h>

#include <Eigen/LU>

#include <random>

#include "confidence.hpp"
#include "drive_estimate.hpp"
#include "town.hpp"

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

TEST(DriveEstimate, AStartThatIsNotBelievedInTheEndNeverWasRight) {
  std::vector<ScanRecord> records = drive_with_a_gap();
  records.resize(10);
  for (std::size_t i = 5; i < records.size(); ++i) records[i].located = false;
  for (const EstimatedPose& pose : estimate_drive(records, std::nullopt, {}, {})) EXPECT_TRUE(pose.contradicted);
}

/// A start 500 m off at the fringe of a town: here and there walls fit.
TEST(DriveEstimate, ADriveThatWallsContradictInMostPlacesIsKnownInNone) {
  const auto doubted = [](const std::vector<bool>& contradicted, const std::vector<bool>& located) {
    Confidence sure{std::vector<Matrix6d>(contradicted.size(), 0.01 * Matrix6d::Identity()), contradicted};
    doubt_what_is_contradicted(sure, located);
    return sure;
  };
  const std::vector<bool> all(4, true);
  const Confidence one = doubted({false, true, false, false}, all);
  EXPECT_EQ(one.contradicted, std::vector<bool>({false, true, false, false}));
  EXPECT_LT(one.covariances[0](3, 3), 1);
  const Confidence most = doubted({false, true, true, true}, all);
  EXPECT_EQ(most.contradicted, all);
  for (const Matrix6d& covariance : most.covariances) EXPECT_GT(covariance(3, 3), 50 * 50);
  const Confidence lost_later = doubted({false, false, false, false}, {true, false, false, false});   // says nothing of what came before
  EXPECT_EQ(lost_later.contradicted, std::vector<bool>({false, true, true, true}));
  EXPECT_LT(lost_later.covariances[0](3, 3), 1);
}

TEST(DriveEstimate, WithoutAPriorNoHeightIsDoubted) {
  const auto poses = estimate_drive(drive_with_a_gap(), std::nullopt, {}, {}, 5.0);
  EXPECT_EQ(poses.front().covariance(5, 5), estimate_drive(drive_with_a_gap(), std::nullopt, {}, {}).front().covariance(5, 5));
}

TEST(DriveEstimate, WithoutAPriorTheOdometryStays) {
  const auto poses = estimate_drive(drive_with_a_gap(), std::nullopt, {}, {});
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_NEAR(poses[i].T_map_sensor.translation().x(), static_cast<double>(i), 1e-6) << i;
}

/// House fronts and ground, which tell nothing along the road, and crowns that stand before them: in each cubic metre of these one facet across the road, anywhere in it. So there lies one near
/// wherever the drive is thought to be.
PointCloud avenue() {
  constexpr int first_x = -20, last_x = 45;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0.15, 0.85);
  PointCloud points;
  const auto add = [&](const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    constexpr int along = 6;
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < along; ++j) {
        points.xyz.push_back((corner + (i + 0.5) / along * u + (j + 0.5) / along * v).cast<float>());
        points.normal.push_back(u.cross(v).normalized().cast<float>());
      }
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  for (int along = first_x; along < last_x; ++along) {
    for (int across = -8; across < 8; ++across) add({1.0 * along, 1.0 * across, 0.5}, x, y);
    for (int up = 1; up < 5; ++up) add({1.0 * along, 8.5, 1.0 * up}, x, z), add({1.0 * along, -8.5, 1.0 * up}, z, x);
    for (int across = 3; across < 6; ++across)
      for (const int side : {across, -across - 1})
        for (int up = 1; up < 4; ++up) add({along + part(random), side + 0.1, up + 0.1}, 0.8 * y, 0.8 * z);
  }
  return points;
}

/// A scan that is compared with what lies nearest stays where it is; all together they fit where they were taken (docs/adr/0023).
TEST(DriveEstimate, AlongAnAvenueAStretchIsMovedToWhereAllOfItFits) {
  constexpr double step_m = 2, off_m = 0.75, range_m = 15;
  const PointCloud world = avenue();
  const auto truth = [](std::size_t i) { return test::pose(step_m * static_cast<double>(i), 0, 2, 0); };
  const ReadScan read = [&](std::size_t index) {
    Scan scan;
    for (const Eigen::Vector3f& p : world.xyz) {
      const Eigen::Vector3d p_sensor = p.cast<double>() - truth(index).translation();
      if (p_sensor.norm() < range_m) scan.points.xyz.push_back(p_sensor.cast<float>());
    }
    return scan;
  };
  std::vector<ScanRecord> records;
  for (std::size_t i = 0; i < 13; ++i) {
    OdometryStep step;
    step.T_odom_sensor = truth(i);
    step.joined = i > 0;
    step.information = 1e4 * Matrix6d::Identity();
    step.figures.converged = true;
    records.push_back({i, 0.1 * static_cast<double>(i), step, Eigen::Translation3d(off_m, 0, 0) * truth(i)});
  }
  JointMethodOptions options;
  options.estimate.keyframe_m = step_m;
  const test::TiledPoints tiles(world, 50);
  const auto poses = estimate_drive(records, NearTiles(tiles, MapFrame::local(), 150), read, options);
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_NEAR(poses[i].T_map_sensor.translation().x(), truth(i).translation().x(), 0.05) << i;
}

}  // namespace
}  // namespace priormap
