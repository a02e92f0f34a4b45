#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include <priormap/pointcloud/point_cloud.hpp>

#include "voxel_occupancy.hpp"

namespace priormap {

/// A scan thinned to the first point of each voxel of the map, and those voxels.
struct ThinnedScan {
  PointCloud points;                 ///< in `map`, relative to the sensor
  std::vector<std::uint32_t> bits;   ///< of each point: 512 times the number of its block, and its bit in there
  std::vector<VoxelBlock> blocks;
};

/// @param scan  as seen from `T_map_sensor`   @param range_m  points farther from the sensor are left out
ThinnedScan thinned_in_map(const PointCloud& scan, const Eigen::Isometry3d& T_map_sensor, double voxel_m, double range_m);

}  // namespace priormap
