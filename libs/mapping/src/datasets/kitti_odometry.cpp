// A sequence of the KITTI odometry benchmark: velodyne/*.bin and times.txt. The scans are motion-compensated, and their vertical angles
// are off by a constant that later work found (IMLS-SLAM, CT-ICP: 0.205 deg; OpenLiDARMap: 0.375 deg).
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "datasets/bin_records.hpp"
#include "datasets/dataset.hpp"
#include "datasets/scan_files.hpp"
#include "datasets/vertical_angle.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

constexpr double default_correction_deg = 0.205;

fs::path bin_folder(const fs::path& path) { return fs::is_directory(path / "velodyne") ? path / "velodyne" : path; }

/// Never: a folder of .bin does not tell whether its angles want the correction, so the user says it.
bool recognises(const fs::path&) { return false; }

std::unique_ptr<ScanSource> open(const fs::path& path, const DatasetOptions& options) {
  const fs::path scans = bin_folder(path);
  auto files = files_ending(scans, ".bin");
  auto stamps = read_stamps({scans / "times.txt", scans / ".." / "times.txt"}, files);
  PointTimes point_times(options.point_times, scans, stamps.stamps_s, PointTimes::Otherwise::none);
  const double correction_deg = options.vertical_angle_correction_deg.value_or(default_correction_deg);
  const double correction_rad = correction_deg * std::numbers::pi / 180;
  ScanSourceInfo info{"kitti-odometry", stamps.origin, {}, correction_deg};
  return std::make_unique<ScanFiles>(std::move(info), std::move(files), std::move(stamps.stamps_s), std::move(point_times), [correction_rad](const fs::path& file) {
    PointCloud cloud = read_float_records(file, 4);
    raise_vertical_angles(cloud, correction_rad);
    return cloud;
  });
}

}  // namespace

Dataset kitti_odometry_dataset() { return {"kitti-odometry", recognises, open}; }

}  // namespace priormap
