#pragma once
#include <filesystem>

#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// A KITTI Velodyne scan: 4 x float32 a point (x, y, z, intensity), in the sensor's frame, as the file says: no correction, no filter.
/// Geiger et al., "Vision meets Robotics: The KITTI Dataset", IJRR 2013.
/// @throws IoError, FormatError when the size is no multiple of 16 bytes.
PointCloud read_kitti_bin(const std::filesystem::path& file);
/// The same into a cloud whose memory is used again.
void read_kitti_bin(const std::filesystem::path& file, PointCloud& points);

}  // namespace priormap
