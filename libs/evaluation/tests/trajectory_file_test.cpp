#include <priormap/evaluation/trajectory_file.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "made_trajectories.hpp"
#include <priormap/core/error.hpp>
#include <priormap/evaluation/common_frame.hpp>

namespace priormap {
namespace {

constexpr auto automatic = TrajectoryFormat::automatic;

template <class Error, class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(TrajectoryFile, TumIsKnownByItsEightNumbers) {
  const made::Folder folder;
  const auto file = folder.file("a.txt", "# stamp x y z qx qy qz qw\n0.5 1 2 3 0 0 1 0\r\n\n1.5\t4  5 6 0 0 0 1\n");
  const Trajectory trajectory = read_trajectory(file, automatic, "");
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory.stamps_s, (std::vector<double>{0.5, 1.5}));
  EXPECT_TRUE(trajectory.poses[0].isApprox(made::pose(1, 2, 3, std::numbers::pi), 1e-12));
}

TEST(TrajectoryFile, KittiMayCarryTheIndexFirst) {
  const made::Folder folder;
  const Trajectory plain = read_trajectory(folder.file("a.txt", "1 0 0 7 0 1 0 8 0 0 1 9\n0 -1 0 1 1 0 0 2 0 0 1 3\n"), automatic, "");
  EXPECT_EQ(plain.indices, (std::vector<std::int64_t>{0, 1}));
  EXPECT_TRUE(plain.poses[1].isApprox(made::pose(1, 2, 3, std::numbers::pi / 2), 1e-12));
  const Trajectory indexed = read_trajectory(folder.file("b.txt", "5 1 0 0 7 0 1 0 8 0 0 1 9\n"), automatic, "");
  EXPECT_EQ(indexed.indices, (std::vector<std::int64_t>{5}));
  EXPECT_TRUE(indexed.poses[0].isApprox(plain.poses[0], 0));
}

constexpr const char* projected_csv =
    "index,stamp_s,x_m,y_m,z_m,qx,qy,qz,qw,lon_deg,lat_deg,verdict\n3,0.3,691000,5335000,520,0,0,0,1,11.57,48.14,anchored\n";

TEST(TrajectoryFile, CsvTakesItsCrsFromTheReportBesideIt) {
  const made::Folder folder;
  const auto file = folder.file("trajectory.csv", projected_csv);
  EXPECT_NE(message_of<CrsError>([&] { read_trajectory(file, automatic, ""); }).find("--crs"), std::string::npos);
  EXPECT_EQ(read_trajectory(file, automatic, "EPSG:32632").crs, "EPSG:32632");
  folder.file("run.json", R"({"frame": {"crs": "EPSG:25832+7837"}})");
  const Trajectory trajectory = read_trajectory(file, automatic, "EPSG:32632");
  EXPECT_EQ(trajectory.crs, "EPSG:25832+7837");
  EXPECT_EQ(trajectory.indices, (std::vector<std::int64_t>{3}));
  EXPECT_EQ(trajectory.stamps_s, (std::vector<double>{0.3}));
  folder.file("run.json", R"({"frame": {"crs": null}})");
  EXPECT_EQ(read_trajectory(file, automatic, "").crs, "") << "a local metric frame says so";
  std::filesystem::remove(file.parent_path() / "run.json");
  folder.file("frame.json", R"({"crs": "EPSG:25833"})");
  EXPECT_EQ(read_trajectory(file, automatic, "").crs, "EPSG:25833");
}

TEST(TrajectoryFile, CsvWithBothFramesIsReadOnTheGridOnlyWhenItsCrsIsKnown) {
  const made::Folder folder;
  const auto file = folder.file("truth.csv",
                                "index,x_m,y_m,z_m,qx,qy,qz,qw,east_m,north_m,height_m,grid_qx,grid_qy,grid_qz,grid_qw,lat_deg,lon_deg\n"
                                "0,1,2,3,0,0,0,1,640000,5359000,3,0,0,1,0,48.4,10.9\n");
  const Trajectory local = read_trajectory(file, automatic, "");
  EXPECT_EQ(local.crs, "");
  EXPECT_EQ(local.poses[0].translation().x(), 1);
  const Trajectory grid = read_trajectory(file, automatic, "EPSG:25832");
  EXPECT_EQ(grid.crs, "EPSG:25832");
  EXPECT_TRUE(grid.poses[0].isApprox(made::pose(640000, 5359000, 3, std::numbers::pi), 1e-12));
}

// Karlsruhe lies 0.42 degrees west of the central meridian of zone 32: there grid north is west of true north, and yaw against the grid's east differs.
TEST(TrajectoryFile, OxtsComesInMetresAgainstTrueEast) {
  const made::Folder folder;
  const auto file = folder.file("oxts.csv",
                                "frame,unix_time_s,lat_deg,lon_deg,alt_m,roll_rad,pitch_rad,yaw_rad,vf_mps\n"
                                "0,10.0,49.0150,8.4300,116,0.01,-0.02,0.5,3\n1,10.1,49.0160,8.4300,117,0,0,0.5,3\n");
  Trajectory reference = read_trajectory(file, automatic, ""), estimate = reference;
  EXPECT_EQ(reference.crs, "EPSG:32632");
  to_common_frame(reference, estimate);
  const Eigen::Vector3d moved = reference.poses[1].translation() - reference.poses[0].translation();
  constexpr double arc_of_a_milli_degree_m = 111.211;   // of the meridian at 49 N (GRS80), 116 m up
  EXPECT_NEAR(moved.y(), arc_of_a_milli_degree_m, 0.01);
  EXPECT_NEAR(moved.x(), 0, 1e-3) << "due north";
  EXPECT_NEAR(moved.z(), 1, 1e-9);
  const Eigen::Vector3d forward = reference.poses[0].linear().col(0);
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 0.5, 1e-9);
  EXPECT_NEAR(-std::asin(forward.z()), -0.02, 1e-9) << "a positive pitch looks down";
}

TEST(TrajectoryFile, SaysWhichLineIsNoPose) {
  const made::Folder folder;
  const auto reads = [&](const std::string& text) {
    const auto file = folder.file("bad.txt", text);
    return message_of<FormatError>([&] { read_trajectory(file, automatic, ""); });
  };
  EXPECT_NE(reads("0 1 2 3 0 0 0 1\n1 1 2 3 0 0 0\n").find("line 2: 7 numbers instead of TUM's 8 (t x y z qx qy qz qw); the file may end too early"), std::string::npos);
  EXPECT_NE(reads("0 nan 2 3 0 0 0 1\n").find("line 1: 'nan' is no finite number"), std::string::npos);
  EXPECT_NE(reads("0 1 2 3 0 0 0 5\n").find("not of unit length"), std::string::npos);
  EXPECT_NE(reads("1 0 0 0 0 1 0 0 0 0 -1 0\n").find("no rotation"), std::string::npos);
  EXPECT_NE(reads("1 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n").find("backwards"), std::string::npos);
  EXPECT_NE(reads("0.5 1 0 0 0 0 1 0 0 0 0 1 0\n").find("no whole number"), std::string::npos);
  EXPECT_NE(reads("# nothing\n\n").find("holds no poses"), std::string::npos);
  EXPECT_NE(reads("1 2 3\n").find("neither TUM"), std::string::npos);
  EXPECT_NE(reads("index,x_m\n0,1\n").find("its header has no poses"), std::string::npos);
  EXPECT_NE(reads("x_m,y_m,z_m,qx,qy,qz,qw\n").find("holds no poses"), std::string::npos);
  EXPECT_NE(reads("x_m,y_m,z_m,qx,qy,qz,qw\n1,2,3\n").find("3 fields under a header of 7; the file may end too early"), std::string::npos);
  EXPECT_EQ(reads("x_m,y_m,z_m,qx,qy,qz,qw\n1,2,3\n1,2,3,0,0,0,1\n").find("too early"), std::string::npos) << "a fault in the middle is no cut";
  EXPECT_NE(message_of<IoError>([] { read_trajectory("absent.txt", automatic, ""); }).find("absent.txt"), std::string::npos);
  EXPECT_NE(message_of<IoError>([] { read_trajectory(".", automatic, ""); }).find("directory"), std::string::npos);
}

// KITTI: camera z looks forward, y down; the velodyne's x looks forward, z up.
TEST(KittiCalibration, TurnsCameraTruthIntoTheVelodynesAxes) {
  const made::Folder folder;
  const auto file = folder.file("calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0.1 0 0 -1 -0.2 1 0 0 -0.3\n");
  Trajectory trajectory = read_trajectory(folder.file("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 -0.5 0 0 1 20\n"), automatic, "");
  camera_to_velodyne(trajectory, read_kitti_calibration(file));
  EXPECT_TRUE(trajectory.poses[0].isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  EXPECT_TRUE(trajectory.poses[1].isApprox(made::pose(20, 0, 0.5), 1e-12));
  EXPECT_THROW(read_kitti_calibration(folder.file("none.txt", "P0: 1 2 3\n")), FormatError);
}

}  // namespace
}  // namespace priormap
