#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <priormap/core/error.hpp>
#include <priormap/mapping/datasets.hpp>

#include "datasets/file_numbers.hpp"

#include "scan_folder.hpp"

namespace priormap {
namespace {

using test::Folder;
using test::write_raw;
using test::write_text;

const std::vector<float> two_points = {10, 1, 0.5f, 0.25f, 20, -3, 2, 0.75f};

template <class Error>
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no such error";
}

TEST(Datasets, BinFolderIsReadAsItIs) {
  const Folder folder;
  write_raw(folder.path() / "velodyne" / "000000.bin", two_points);
  write_raw(folder.path() / "velodyne" / "000001.bin", two_points);
  write_text(folder.path() / "times.txt", "0.5\n0.625\n");
  const auto source = open_scans(folder.path());
  ASSERT_EQ(source->size(), 2u);
  EXPECT_EQ(source->info().dataset, "bin");
  const Scan scan = source->read(1);
  EXPECT_EQ(scan.stamp_s, 0.625);
  ASSERT_EQ(scan.points.size(), 2u);
  EXPECT_EQ(scan.points.xyz[1], Eigen::Vector3f(20, -3, 2));
  EXPECT_EQ(scan.points.intensity[1], 0.75f);
}

TEST(Datasets, NumbersInNamesAreOrderedByValue) {
  const Folder folder;
  for (const char* name : {"10.bin", "9.bin", "100.bin"}) write_raw(folder.path() / name, two_points);
  const auto source = open_scans(folder.path());
  EXPECT_EQ(source->file(0).filename(), "9.bin");
  EXPECT_EQ(source->file(2).filename(), "100.bin");
}

TEST(Datasets, PointsThatAreNoMeasurementAreLeftOutWithTheirTimes) {
  const Folder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write_raw(folder.path() / "0.bin", std::vector<float>{nan, 0, 0, 0, 1, 2, 3, 0, 0, 0, 0, 0, 4, std::numeric_limits<float>::infinity(), 0, 0, 5, 6, 7, 0});
  write_raw(folder.path() / "point_times" / "0.f32", std::vector<float>{-0.2f, -0.1f, 0, 0.1f, 0.2f});
  const Scan scan = open_scans(folder.path())->read(0);
  ASSERT_EQ(scan.points.size(), 2u);
  EXPECT_EQ(scan.num_skipped, 3u);
  EXPECT_EQ(scan.points.xyz[1], Eigen::Vector3f(5, 6, 7));
  EXPECT_EQ(scan.points.time_s, (std::vector<float>{-0.1f, 0.2f}));
}

TEST(Datasets, AScanCutShortNamesItsFile) {
  const Folder folder;
  write_text(folder.path() / "000003.bin", "1234567890");
  const auto source = open_scans(folder.path());
  EXPECT_NE(message_of<FormatError>([&] { source->read(0); }).find("000003.bin: cut short"), std::string::npos);
}

TEST(Datasets, StampsThatDoNotFitAreRefused) {
  const Folder folder;
  write_raw(folder.path() / "0.bin", two_points);
  write_text(folder.path() / "times.txt", "0\n0.1\n");
  EXPECT_NE(message_of<FormatError>([&] { open_scans(folder.path()); }).find("2 stamps for 1 scans"), std::string::npos);
  write_text(folder.path() / "times.txt", "soon\n");
  EXPECT_NE(message_of<FormatError>([&] { open_scans(folder.path()); }).find("'soon' is no time"), std::string::npos);
}

TEST(Datasets, StampsGoByNumberWhereScansAreMissing) {
  const Folder folder;
  const auto scans = folder.path() / "velodyne";
  const auto stamps = [&](const char* times) {
    write_text(folder.path() / "times.txt", times);
    const auto source = open_scans(folder.path());
    std::vector<double> stamps_s;
    for (std::size_t i = 0; i < source->size(); ++i) stamps_s.push_back(source->stamp_s(i));
    return stamps_s;
  };
  for (const char* name : {"000001.bin", "000002.bin", "000004.bin", "000005.bin"}) write_raw(scans / name, two_points);
  EXPECT_EQ(stamps("1 2 3 4 5"), (std::vector<double>{1, 2, 4, 5})) << "counted from the first scan";
  EXPECT_EQ(stamps("0 1 2 3 4 5"), (std::vector<double>{1, 2, 4, 5})) << "counted from zero, which is missing too";
  EXPECT_EQ(stamps("1 2 4 5"), (std::vector<double>{1, 2, 4, 5})) << "one a scan: whoever lost the scan lost its stamp";
  EXPECT_NE(message_of<FormatError>([&] { stamps("0 1 2 3 4 5 6"); }).find("7 stamps for 4 scans, 000001.bin to 000005.bin"), std::string::npos);
  std::filesystem::remove(folder.path() / "times.txt");
  EXPECT_NEAR(open_scans(folder.path())->stamp_s(2), 0.3, 1e-9) << "without stamps the gap takes its time too";
  write_raw(scans / "of_another_name.bin", two_points);
  EXPECT_NE(message_of<FormatError>([&] { stamps("0 1 2 3 4 5"); }).find("6 stamps for 5 scans;"), std::string::npos) << "not counted by name";
}

TEST(Datasets, MissingFilesAreFoundByTheNumbersInNames) {
  const auto missing = [](const std::vector<std::filesystem::path>& files) {
    const MissingFiles found = missing_files(files);
    return std::to_string(found.count) + found.first;
  };
  EXPECT_EQ(missing({"a/000028.bin", "a/000029.bin", "a/000031.bin"}), "1000030.bin");
  EXPECT_EQ(missing({"9.pcd", "12.pcd", "13.pcd", "15.pcd", "16.pcd"}), "310.pcd");
  EXPECT_EQ(missing({"frame_1.ply", "frame_2.ply", "frame_4.ply"}), "1frame_3.ply");
  EXPECT_EQ(missing({"8.bin", "9.bin", "10.bin"}), "0");
  EXPECT_EQ(missing({"00.bin", "05.bin", "10.bin", "15.bin"}), "0") << "every fifth of them";
  EXPECT_EQ(missing({"1403636579763555584.pcd", "1403636579863555584.pcd", "1403636579963555584.pcd"}), "0") << "times of a clock";
  EXPECT_EQ(missing({"left.pcd", "right.pcd"}), "0");
  EXPECT_EQ(missing({}), "0");
}

TEST(Datasets, ScansAreLookedForAndMissed) {
  const Folder folder;
  EXPECT_NE(message_of<FormatError>([&] { open_scans(folder.path()); }).find("no scans found"), std::string::npos);
  EXPECT_NE(message_of<IoError>([&] { open_scans(folder.path() / "none"); }).find("no such file or folder"), std::string::npos);
  EXPECT_NE(message_of<UsageError>([&] { open_scans(folder.path(), {"sonar", "", {}}); }).find("no dataset is called 'sonar'"), std::string::npos);
}

TEST(Datasets, KittiOdometryRaisesVerticalAnglesAndKeepsRangeAndAzimuth) {
  const Folder folder;
  write_raw(folder.path() / "velodyne" / "000000.bin", two_points);
  const auto source = open_scans(folder.path(), {"kitti-odometry", "", {}});
  EXPECT_EQ(source->info().vertical_angle_correction_deg, 0.205);
  const auto scan = source->read(0);
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Vector3d p(two_points[4 * i], two_points[4 * i + 1], two_points[4 * i + 2]);
    // The published correction: a rotation about p x e_z.
    const Eigen::Vector3d corrected = Eigen::AngleAxisd(0.205 * std::numbers::pi / 180, p.cross(Eigen::Vector3d::UnitZ()).normalized()) * p;
    EXPECT_LT((scan.points.position(i) - corrected).norm(), 1e-5);
  }
}

TEST(Datasets, TheCorrectionBelongsToKittiOdometryAlone) {
  const Folder folder;
  write_raw(folder.path() / "0.bin", two_points);
  EXPECT_THROW(open_scans(folder.path(), {"bin", "", 0.3}), UsageError);
}

TEST(Datasets, KittiRawStampsCountNanosecondsAndPointsTakeTheSpinsTime) {
  const Folder folder;
  // Straight ahead, left, right: the sensor turns clockwise and its stamp is the moment it looks forward.
  write_raw(folder.path() / "velodyne_points" / "data" / "0000000000.bin", std::vector<float>{10, 0, 0, 0, 0, 10, 0, 0, 0, -10, 0, 0});
  write_text(folder.path() / "velodyne_points" / "timestamps.txt", "2011-09-26 13:02:25.951199337\n");
  const auto source = open_scans(folder.path());
  EXPECT_EQ(source->info().dataset, "kitti-raw");
  const Scan scan = source->read(0);
  EXPECT_NEAR(scan.stamp_s, 1317042145.951199337, 1e-6);
  EXPECT_NEAR(scan.points.time_s[0], 0, 1e-7);
  EXPECT_NEAR(scan.points.time_s[1], -0.025, 1e-7);
  EXPECT_NEAR(scan.points.time_s[2], 0.025, 1e-7);
}

TEST(Datasets, PointsCanBeGivenTheTimesOfASpinningHeadOrNone) {
  const Folder folder;
  for (const char* name : {"0.bin", "1.bin"}) write_raw(folder.path() / name, std::vector<float>{10, 0, 0, 0, 0, 10, 0, 0});
  write_text(folder.path() / "times.txt", "0\n0.2\n");   // 5 Hz
  const auto clockwise = open_scans(folder.path(), {"bin", "clockwise", {}});
  EXPECT_NEAR(clockwise->read(1).points.time_s.at(1), -0.05, 1e-7) << "left of the way ahead: seen before it";
  EXPECT_EQ(clockwise->info().point_times, "spinning model, clockwise");
  EXPECT_NEAR(open_scans(folder.path(), {"bin", "counter-clockwise", {}})->read(0).points.time_s.at(1), 0.05, 1e-7);
  EXPECT_TRUE(open_scans(folder.path(), {"bin", "", {}})->read(0).points.time_s.empty());
  write_raw(folder.path() / "point_times" / "0.f32", std::vector<float>{-0.1f, 0.2f});
  EXPECT_EQ(open_scans(folder.path(), {"bin", "", {}})->read(0).points.time_s.size(), 2u);
  EXPECT_TRUE(open_scans(folder.path(), {"bin", "none", {}})->read(0).points.time_s.empty());
}

TEST(Datasets, TimesInAnUnknownUnitAreRefused) {
  const Folder folder;
  write_raw(folder.path() / "0.bin", std::vector<float>{10, 0, 0, 0, 0, 10, 0, 0});
  write_raw(folder.path() / "point_times" / "0.f32", std::vector<float>{0, 99000});   // microseconds
  EXPECT_THROW(open_scans(folder.path())->read(0), FormatError);
}

TEST(Datasets, PointsWithoutATimeAreLeftOutWhereOthersHaveOne) {
  const Folder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write_raw(folder.path() / "0.bin", std::vector<float>{1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0});
  write_raw(folder.path() / "point_times" / "0.f32", std::vector<float>{nan, 0.1f, nan});
  const Scan scan = open_scans(folder.path())->read(0);
  EXPECT_EQ(scan.num_skipped, 2u);
  EXPECT_EQ(scan.points.time_s, (std::vector<float>{0.1f}));
}

TEST(Datasets, MissingReturnsCarryAnyTime) {
  const Folder folder;
  const std::string head = "VERSION 0.7\nFIELDS x y z timestamp\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 4\nHEIGHT 1\nPOINTS 4\nDATA ascii\n";
  for (const char* missing : {"nan nan nan 0\n", "0 0 0 0\n", "nan nan nan nan\n"}) {
    write_text(folder.path() / "0.pcd", head + missing + "10 0 0 1700000000.5\n0 10 0 1700000000.25\n" + missing);
    const Scan scan = open_scans(folder.path())->read(0);
    EXPECT_EQ(scan.num_skipped, 2u) << missing;
    EXPECT_EQ(scan.points.time_s, (std::vector<float>{0.25f, 0})) << missing;
  }
}

TEST(Datasets, NcltIsDecodedWithZUp) {
  const Folder folder;
  // x = 1 m, y = 2 m to the right, z = 3 m down in NCLT's body frame
  const std::uint16_t x = 20200, y = 20400, z = 20600, rest = 0x0102;
  write_raw(folder.path() / "velodyne_sync" / "1357847238104231.bin", std::vector<std::uint16_t>{x, y, z, rest});
  const auto source = open_scans(folder.path());
  EXPECT_EQ(source->info().dataset, "nclt");
  EXPECT_NEAR(source->stamp_s(0), 1357847238.104231, 1e-6);
  EXPECT_LT((source->read(0).points.position(0) - Eigen::Vector3d(1, -2, -3)).norm(), 1e-4);
}

TEST(Datasets, NuscenesPointsForward) {
  const Folder folder;
  write_raw(folder.path() / "n008__LIDAR_TOP__1533151603547590.pcd.bin", std::vector<float>{1, 10, -1, 0, 3});
  const auto source = open_scans(folder.path());
  EXPECT_EQ(source->info().dataset, "nuscenes");
  EXPECT_NEAR(source->stamp_s(0), 1533151603.547590, 1e-6);
  EXPECT_EQ(source->read(0).points.xyz[0], Eigen::Vector3f(10, -1, -1));
}

TEST(Datasets, OneFileIsASequenceOfOneScan) {
  const Folder folder;
  write_raw(folder.path() / "a.bin", two_points);
  write_raw(folder.path() / "b.bin", two_points);
  EXPECT_EQ(open_scans(folder.path() / "a.bin")->size(), 1u);
}

}  // namespace
}  // namespace priormap
