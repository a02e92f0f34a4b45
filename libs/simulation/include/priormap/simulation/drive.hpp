#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/core/option_field.hpp>
#include <priormap/simulation/drive_path.hpp>
#include <priormap/simulation/lidar.hpp>
#include <priormap/simulation/source_view.hpp>
#include <priormap/simulation/town_generator.hpp>

namespace priormap {

/// Where the drive is and how it goes.
struct RouteOptions {
  std::string crs = "EPSG:25832+7837";
  std::vector<double> origin_lon_lat{8.390366100045, 48.98254523586602};
  double origin_height_m = 116;
  double start_yaw_deg = 59.56;
  std::optional<std::string> terrain;
  std::string trajectory_axes = "camera";
  int num_scans = 0;
  int first_scan = 0;
  double town_size_m = 500;
  double speed_mps = 8.3;
  std::optional<double> rate_hz;
  bool there_and_back = false;
  double traffic_spacing_m = 0;
  double rural_m = 0;
  double start_error_m = 0.5;
  double start_error_deg = 1;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("crs", crs, {"projected CRS of sources and truth, with heights"});
    visit("origin", origin_lon_lat, {"LON,LAT of the first pose, WGS 84 (generated towns)", "deg", -180, 180});
    visit("origin-height", origin_height_m, {"ground at the first pose, in the CRS's heights", "m", -500, 9000});
    visit("start-yaw", start_yaw_deg, {"direction of a trajectory's first pose, counter-clockwise from true east", "deg", -360, 360});
    visit("terrain", terrain, {"terrain model that gives the ground; default: the trajectory's own heights, or hills"});
    visit("trajectory-axes", trajectory_axes, {"camera (KITTI: x right, y down, z forward) or lidar (x forward, y left, z up)"});
    visit("scans", num_scans, {"number of scans; 0: all of the trajectory, 300 on a route", "", 0, 1e7});
    visit("first", first_scan, {"first pose of the trajectory to use", "", 0, 1e7});
    visit("town-size", town_size_m, {"extent of a generated town's streets", "m", 100, 20000});
    visit("speed", speed_mps, {"speed on straight stretches of a route", "m/s", 0.1, 60});
    visit("rate", rate_hz, {"scans per second; default: the sensor's", "Hz", 0.1, 100});
    visit("there-and-back", there_and_back, {"drive the route out, and back on the other side of the street"});
    visit("traffic-spacing", traffic_spacing_m, {"mean distance between moving cars of one direction; 0: none", "m", 0, 1e6});
    visit("rural", rural_m, {"length of the drive, around its middle, along which hardly a house stands (generated towns)", "m", 0, 1e6});
    visit("start-error", start_error_m, {"horizontal error of truth/initial_pose.txt", "m", 0, 100});
    visit("start-error-yaw", start_error_deg, {"yaw error of truth/initial_pose.txt", "deg", 0, 180});
  }
};

/// Scans of another street in the middle of the drive, as if the vehicle had been carried off and brought back to where it was, or to where it would have been by then.
struct KidnapOptions {
  int at_scan = 0;
  int num_scans = 60;
  bool drives_on = false;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("kidnap-at", at_scan, {"scan before which scans of another street come in; 0: none", "", 0, 1e7});
    visit("kidnap-scans", num_scans, {"how many of them", "", 1, 1e6});
    visit("kidnap-drives-on", drives_on, {"they come in place of as many of its own"});
  }
};

struct DriveOptions {
  std::string town = "generated";            ///< or an OSM file
  std::optional<std::string> trajectory;     ///< poses to follow; none: a route along the streets
  std::string sensor = "hdl64";
  std::uint64_t seed = 1;
  RouteOptions route;
  KidnapOptions kidnap;
  TownOptions town_options;
  SourceErrorOptions errors;
  PlatformOptions platform;
  LidarNoise noise;
};

struct DriveSummary {
  std::size_t num_scans = 0, num_points = 0, num_buildings = 0, num_missing = 0, num_default_height = 0;
  double length_m = 0;
  double simulate_ms_per_scan = 0;   ///< casting, noise and writing, wall clock over all threads
};

/// Simulates a drive and writes DIR: velodyne/NNNNNN.bin, times.txt, point_times/ (with motion distortion), truth/ (trajectory.csv, poses_kitti.txt,
/// initial_pose.txt, frame.json, buildings.csv), sources/ (town.osm.pbf, dsm.tif, dtm.tif), drive.json. docs/man/drivesim.1.md describes each.
/// Same options, same bytes, whatever `threads`. Whole or not at all.
/// @throws UsageError, CrsError, IoError, FormatError
DriveSummary simulate_drive(const DriveOptions& options, const std::filesystem::path& output, Overwrite overwrite, int threads,
                            const Events& events);

}  // namespace priormap
