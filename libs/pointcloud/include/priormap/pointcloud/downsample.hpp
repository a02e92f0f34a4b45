#pragma once
#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// One point a voxel: the first in input order (deterministic). All columns kept. `voxel_m` > 0.
PointCloud voxel_downsample_first(const PointCloud& points, double voxel_m);
/// One point a voxel: the centroid of positions (and mean normal where present); output in order of first occurrence.
PointCloud voxel_downsample_centroid(const PointCloud& points, double voxel_m);

}  // namespace priormap
