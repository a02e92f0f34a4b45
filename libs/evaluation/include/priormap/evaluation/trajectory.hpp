#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

namespace priormap {

/// Poses T_world_sensor in order of time. `stamps_s` is empty (KITTI files) or as long as `poses`.
struct Trajectory {
  std::vector<double> stamps_s;
  std::vector<Eigen::Isometry3d> poses;
  std::string crs;      ///< of a CSV with projected coordinates; empty: a metric frame
  std::size_t size() const { return poses.size(); }
};

}  // namespace priormap
