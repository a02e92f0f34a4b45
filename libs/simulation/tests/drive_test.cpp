#include <priormap/simulation/drive.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/geodesy/map_frame.hpp>
#include <priormap/sources/height_raster.hpp>
#include <priormap/sources/osm_footprints.hpp>

namespace priormap {
namespace {

namespace fs = std::filesystem;

DriveOptions small_drive() {
  DriveOptions options;
  options.route.num_scans = 4;
  options.route.town_size_m = 100;
  options.noise.motion_distortion = true;
  return options;
}

fs::path fresh(const std::string& name) {
  const fs::path path = fs::path(testing::TempDir()) / ("priormap_drive_" + name + "_" + std::to_string(::getpid()));   // tests run side by side
  fs::remove_all(path);
  return path;
}

std::map<std::string, std::string> hashes(const fs::path& root) {
  std::map<std::string, std::string> result;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.is_regular_file()) result[fs::relative(entry.path(), root).string()] = sha256_file(entry.path());
  return result;
}

std::vector<std::vector<double>> table(const fs::path& file, char separator, bool has_header) {
  std::ifstream input(file);
  std::vector<std::vector<double>> rows;
  std::string line;
  if (has_header) std::getline(input, line);
  while (std::getline(input, line)) {
    rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, separator);) rows.back().push_back(std::stod(word));
  }
  return rows;
}

/// One drive for all the questions below.
class Drive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = fresh("common");
    summary_ = simulate_drive(small_drive(), root_, Overwrite::refuse, 2, {});
  }
  static void TearDownTestSuite() { fs::remove_all(root_); }
  static MapFrame frame() {
    const auto first = table(root_ / "truth/trajectory.csv", ',', true).front();
    const auto json = nlohmann::json::parse(std::ifstream(root_ / "truth/frame.json"));
    return MapFrame::at(Crs::parse(json.at("crs")), {first[2], first[3], first[4]});
  }
  static Eigen::Isometry3d pose_of(const std::vector<double>& row, std::size_t first) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << row[first], row[first + 1], row[first + 2];
    pose.linear() = Eigen::Quaterniond(row[first + 6], row[first + 3], row[first + 4], row[first + 5]).toRotationMatrix();
    return pose;
  }
  inline static fs::path root_;
  inline static DriveSummary summary_;
};

TEST_F(Drive, SameSeedSameBytesForAnyThreadCount) {
  const fs::path again = fresh("again"), other = fresh("other");
  simulate_drive(small_drive(), again, Overwrite::refuse, 1, {});
  EXPECT_EQ(hashes(root_), hashes(again));
  DriveOptions options = small_drive();
  options.seed = 2;
  simulate_drive(options, other, Overwrite::refuse, 1, {});
  const auto a = hashes(root_), b = hashes(other);
  for (const char* file : {"velodyne/000000.bin", "sources/town.osm.pbf", "sources/dsm.tif", "sources/dtm.tif", "truth/trajectory.csv"})
    EXPECT_NE(a.at(file), b.at(file)) << file;
  fs::remove_all(again);
  fs::remove_all(other);
}

TEST_F(Drive, WritesWhatTheCommandLineDocsName) {
  for (const char* file : {"velodyne/000000.bin", "velodyne/000003.bin", "point_times/000003.f32", "times.txt", "truth/trajectory.csv", "truth/poses_kitti.txt",
                           "truth/initial_pose.txt", "truth/frame.json", "truth/buildings.csv", "sources/town.osm.pbf", "sources/dsm.tif",
                           "sources/dtm.tif", "drive.json"})
    EXPECT_TRUE(fs::exists(root_ / file)) << file;
  EXPECT_EQ(fs::file_size(root_ / "velodyne/000003.bin"), 4 * fs::file_size(root_ / "point_times/000003.f32"));
  EXPECT_GT(summary_.num_points / summary_.num_scans, 90000u);
  EXPECT_EQ(table(root_ / "times.txt", ' ', false).size(), 4u);
}

TEST_F(Drive, ProjectedAndMapPosesAreTheSamePoses) {
  const MapFrame map = frame();
  const auto projected = table(root_ / "truth/trajectory.csv", ',', true), metric = table(root_ / "truth/poses_kitti.txt", ' ', false);
  ASSERT_EQ(projected.size(), metric.size());
  for (std::size_t i = 0; i < metric.size(); ++i) {
    const Eigen::Isometry3d a = map.pose_to_map(pose_of(projected[i], 2));
    Eigen::Isometry3d b = Eigen::Isometry3d::Identity();
    b.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(metric[i].data());
    EXPECT_LT((a.translation() - b.translation()).norm(), 2e-4);
    EXPECT_LT((a.linear() - b.linear()).norm(), 1e-6);
  }
  EXPECT_LT(Eigen::Vector2d(metric[0][3], metric[0][7]).norm(), 1e-3) << "the frame's origin is the first pose";
}

TEST_F(Drive, InitialPoseIsOffByTheStartError) {
  const Eigen::Isometry3d truth = pose_of(table(root_ / "truth/trajectory.csv", ',', true).front(), 2);
  const Eigen::Isometry3d start = pose_of(table(root_ / "truth/initial_pose.txt", ',', false).front(), 0);
  EXPECT_NEAR((start.translation() - truth.translation()).norm(), 0.5, 0.002);
  EXPECT_NEAR(Eigen::AngleAxisd(truth.linear().transpose() * start.linear()).angle() * 180 / M_PI, 1, 1e-3);
}

TEST_F(Drive, OsmFileReadsBackWithTheBuildingsThatAreNotMissing) {
  Diagnostics diagnostics;
  const auto footprints = read_osm_footprints({root_ / "sources/town.osm.pbf"}, 1, diagnostics);
  EXPECT_EQ(footprints.size(), summary_.num_buildings - summary_.num_missing);
  EXPECT_EQ(diagnostics.total(), 0u);
  std::size_t without_height = 0;
  for (const Footprint& footprint : footprints) without_height += !footprint.attributes.height_m && !footprint.attributes.levels;
  EXPECT_EQ(without_height, summary_.num_default_height);
}

TEST_F(Drive, BuildingsOfTheOsmFileAreRoofsOfTheSurfaceModel) {
  const Crs crs = Crs::parse("EPSG:25832+7837");
  const HeightRaster dsm = HeightRaster::open(root_ / "sources/dsm.tif", std::nullopt, crs), dtm = HeightRaster::open(root_ / "sources/dtm.tif", std::nullopt, crs);
  const Transformer to_crs(Crs::parse("EPSG:4326"), crs.horizontal());
  Diagnostics diagnostics;
  int roofs = 0, total = 0;
  for (const Footprint& footprint : read_osm_footprints({root_ / "sources/town.osm.pbf"}, 1, diagnostics)) {
    if (footprint.rings.size() > 1) continue;
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : footprint.rings[0]) centre += p / static_cast<double>(footprint.rings[0].size());
    const Eigen::Vector3d p = to_crs.forward(Eigen::Vector3d(centre.x(), centre.y(), 0));
    const auto top = dsm.at(p.x(), p.y()), ground = dtm.at(p.x(), p.y());
    ASSERT_TRUE(top && ground);
    roofs += *top - *ground > 2;
    ++total;
  }
  EXPECT_GT(total, 20);
  EXPECT_GT(roofs, 0.9 * total);
}

TEST_F(Drive, GroundUnderTheCarIsWhereTheTerrainModelHasIt) {
  const HeightRaster dtm = HeightRaster::open(root_ / "sources/dtm.tif", std::nullopt, Crs::parse("EPSG:25832+7837"));
  for (const auto& row : table(root_ / "truth/trajectory.csv", ',', true)) {
    const auto ground = dtm.at(row[2], row[3]);
    ASSERT_TRUE(ground);
    EXPECT_NEAR(row[4] - *ground, 1.73, 0.25);
  }
}

/// Places the points by the true poses, goes through the CRS and asks the terrain model: most low points lie on it.
TEST_F(Drive, PointsPlacedByTheTruthLieOnTheGround) {
  const MapFrame map = frame();
  const HeightRaster dtm = HeightRaster::open(root_ / "sources/dtm.tif", std::nullopt, map.projected());
  const auto poses = table(root_ / "truth/poses_kitti.txt", ' ', false);
  std::vector<float> values(fs::file_size(root_ / "velodyne/000002.bin") / sizeof(float));
  std::ifstream(root_ / "velodyne/000002.bin", std::ios::binary).read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  T_map_sensor.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(poses[2].data());
  int low = 0, on_ground = 0;
  for (std::size_t i = 0; i < values.size(); i += 4) {
    const Eigen::Vector3d p_sensor(values[i], values[i + 1], values[i + 2]);
    if (p_sensor.head<2>().norm() > 8) continue;
    const Eigen::Vector3d p = map.to_projected(T_map_sensor * p_sensor);
    const auto ground = dtm.at(p.x(), p.y());
    ASSERT_TRUE(ground);
    ++low;
    on_ground += std::abs(p.z() - *ground) < 0.25;
  }
  EXPECT_GT(low, 10000);
  EXPECT_GT(on_ground, 0.6 * low);
}

/// Bytes of the scans in the order of the drive.
std::vector<std::string> scan_hashes(const fs::path& root) {
  std::vector<std::string> result;
  for (const auto& [name, hash] : hashes(root / "velodyne")) result.push_back(hash);
  return result;
}

TEST_F(Drive, KidnappingSplicesInScansOfAnotherStreet) {
  const fs::path root = fresh("kidnapped");
  DriveOptions options = small_drive();
  options.kidnap = {2, 3};
  EXPECT_EQ(simulate_drive(options, root, Overwrite::refuse, 2, {}).num_scans, 7u);

  // The old street goes on as if nothing had happened, and the sources know nothing of it.
  std::vector<std::string> own = scan_hashes(root);
  own.erase(own.begin() + 2, own.begin() + 5);
  EXPECT_EQ(own, scan_hashes(root_));
  for (const char* file : {"sources/town.osm.pbf", "sources/dsm.tif", "truth/buildings.csv", "truth/initial_pose.txt"})
    EXPECT_EQ(sha256_file(root / file), sha256_file(root_ / file)) << file;

  const auto truth = table(root / "truth/trajectory.csv", ',', true), undisturbed = table(root_ / "truth/trajectory.csv", ',', true);
  ASSERT_EQ(truth.size(), 7u);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool kidnapped = i >= 2 && i < 5;
    EXPECT_EQ(truth[i].back(), kidnapped ? 1 : 0);
    EXPECT_NEAR(truth[i][1], 0.1 * static_cast<double>(i), 1e-6) << "stamps go on";
    const auto& before = undisturbed[1];
    EXPECT_EQ(std::hypot(truth[i][2] - before[2], truth[i][3] - before[3]) > 50, kidnapped);
    if (!kidnapped) {
      EXPECT_EQ(truth[i][2], undisturbed[i < 2 ? i : i - 3][2]);
    }
  }
  fs::remove_all(root);
}

TEST_F(Drive, AKidnappedVehicleMayDriveOnMeanwhile) {
  const fs::path root = fresh("kidnapped_driving");
  DriveOptions options = small_drive();
  options.kidnap = {1, 2, true};
  EXPECT_EQ(simulate_drive(options, root, Overwrite::refuse, 2, {}).num_scans, 4u);
  const std::vector<std::string> scans = scan_hashes(root), undisturbed = scan_hashes(root_);
  const auto truth = table(root / "truth/trajectory.csv", ',', true);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const bool kidnapped = i == 1 || i == 2;
    EXPECT_EQ(scans[i] == undisturbed[i], !kidnapped) << i;
    EXPECT_EQ(truth[i].back(), kidnapped ? 1 : 0);
    EXPECT_NEAR(truth[i][1], 0.1 * static_cast<double>(i), 1e-6);
  }
  fs::remove_all(root);
}

/// A file of 40 poses along a bend, in lidar axes.
fs::path recorded_bend() {
  const fs::path file = fresh("bend.txt");
  std::ofstream out(file);
  for (int i = 0; i < 40; ++i) {
    const double s = 0.8 * i, yaw = 0.02 * s;
    out << 0.1 * i << ' ' << 50 * std::sin(yaw) << ' ' << 50 * (1 - std::cos(yaw)) << " 0 0 0 " << std::sin(yaw / 2) << ' ' << std::cos(yaw / 2) << '\n';
  }
  return file;
}

/// The world of drives along a trajectory is frozen: the published figures were measured in it.
TEST(FrozenWorld, StaysAsItWas) {
  const fs::path root = fresh("frozen"), trajectory = recorded_bend();
  DriveOptions options;
  options.trajectory = trajectory.string();
  options.route.trajectory_axes = "lidar";
  options.route.num_scans = 2;
  options.seed = 5;
  const DriveSummary summary = simulate_drive(options, root, Overwrite::refuse, 1, {});
  std::vector<float> values(fs::file_size(root / "velodyne/000001.bin") / sizeof(float));
  std::ifstream(root / "velodyne/000001.bin", std::ios::binary).read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < values.size(); i += 4) sum += Eigen::Map<const Eigen::Vector4f>(values.data() + i).cast<double>();
  const double num_points = static_cast<double>(values.size()) / 4;
  EXPECT_EQ(summary.num_buildings, 3u);
  EXPECT_NEAR(num_points, 101800, 200);   // the last digits are the processor's
  EXPECT_LT((sum / num_points - Eigen::Vector4d(-1.3195, 0.2299, -1.3169, 0.2689)).norm(), 0.01);
  fs::remove_all(root);
  fs::remove(trajectory);
}

TEST(DriveFaults, AreNamedAndLeaveNothing) {
  const fs::path out = fresh("fault");
  DriveOptions options = small_drive();
  options.route.crs = "EPSG:4326";
  EXPECT_THROW(simulate_drive(options, out, Overwrite::refuse, 1, {}), UsageError);
  options = small_drive();
  options.trajectory = "/nowhere/poses.txt";
  EXPECT_THROW(simulate_drive(options, out, Overwrite::refuse, 1, {}), IoError);
  options = small_drive();
  options.sensor = "abacus";
  EXPECT_THROW(simulate_drive(options, out, Overwrite::refuse, 1, {}), UsageError);
  options = small_drive();
  options.kidnap.at_scan = 4;
  EXPECT_THROW(simulate_drive(options, out, Overwrite::refuse, 1, {}), UsageError);
  options = small_drive();
  options.route.origin_lon_lat = {11};
  EXPECT_THROW(simulate_drive(options, out, Overwrite::refuse, 1, {}), UsageError);
  EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace priormap
