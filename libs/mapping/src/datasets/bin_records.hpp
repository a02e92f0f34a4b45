#pragma once
#include <cstddef>
#include <filesystem>
#include <vector>

#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// Whole file in one read. @throws IoError
std::vector<std::byte> read_bytes(const std::filesystem::path& file);

/// Records of `floats_per_point` float32, the first four x, y, z, intensity (KITTI: 4, nuScenes: 5).
/// @throws FormatError when the file ends inside a record.
PointCloud read_float_records(const std::filesystem::path& file, std::size_t floats_per_point);

}  // namespace priormap
