#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <priormap/core/option_field.hpp>
#include <priormap/simulation/terrain.hpp>

namespace priormap {

/// Where a vehicle is at a time, in the plane: frame `map`, yaw counter-clockwise from east.
struct TrackPoint {
  double stamp_s;
  Eigen::Vector2d position;
  double yaw;
};

/// Poses of the sensor at the stamps of its scans, T_map_sensor; sensor axes forward, left, up.
struct DrivePath {
  std::vector<double> stamps_s;
  std::vector<Eigen::Isometry3d> poses;

  std::size_t size() const { return poses.size(); }
  /// Between the stamps: Catmull-Rom for the position, slerp for the orientation; beyond them straight on.
  Eigen::Isometry3d pose(double stamp_s) const;
};

/// How the vehicle carries the sensor.
struct PlatformOptions {
  double mount_height_m = 1.73;
  double wobble_deg = 0.3;
  double wobble_hz = 1.5;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("mount-height", mount_height_m, {"height of the sensor above the ground", "m", 0.2, 10});
    visit("wobble", wobble_deg, {"amplitude of the platform's pitching and rolling", "deg", 0, 20});
    visit("wobble-frequency", wobble_hz, {"frequency of the pitching", "Hz", 0.05, 4});
  }
};

/// Puts a plane track on wheels: height, pitch and roll follow the ground under them, plus wobble.
DrivePath ride(const std::vector<TrackPoint>& track, const Terrain& terrain, const PlatformOptions& platform, std::uint64_t seed);

/// Reads poses of a recorded drive: rows of 12 numbers (KITTI, a 3x4 matrix) or of 8 (TUM: stamp, position, quaternion).
/// @param axes  "camera": x right, y down, z forward, as KITTI odometry has it; "lidar": x forward, y left, z up
/// @return poses in lidar axes, T_first_k for "camera" files as they are; stamps where the file has them
/// @throws IoError, FormatError
struct RecordedPoses {
  std::vector<double> stamps_s;   ///< empty: none
  std::vector<Eigen::Isometry3d> poses;
};
RecordedPoses read_recorded_poses(const std::filesystem::path& file, const std::string& axes);

/// A line driven along: corners rounded, kept to the right of it by `lane_offset_m`, slower in bends; one point a scan.
/// Ends after `count` scans or where the line ends.
struct DriveSpeed {
  double speed_mps = 8.3;
  double rate_hz = 10;
};
std::vector<TrackPoint> drive_along(const std::vector<Eigen::Vector2d>& line, double lane_offset_m, const DriveSpeed& speed,
                                    std::size_t count);

}  // namespace priormap
