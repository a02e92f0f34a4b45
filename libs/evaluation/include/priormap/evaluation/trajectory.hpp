#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace priormap {

/// Poses T_world_sensor in order of time.
///
/// `world` is a metric frame with z up where `crs` is empty; else the projected CRS named there, orientations against its
/// grid axes. `stamps_s` and `indices` (number of the scan) are empty where the file has none, else as long as `poses`.
struct Trajectory {
  std::vector<double> stamps_s;
  std::vector<std::int64_t> indices;
  std::vector<Eigen::Isometry3d> poses;
  std::string crs;
  std::size_t size() const { return poses.size(); }
};

}  // namespace priormap
