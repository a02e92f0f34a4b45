#pragma once
#include <filesystem>
#include <ostream>
#include <vector>

#include <priormap/pointcloud/point_formats.hpp>

namespace priormap {

using ReadCloud = CloudFile (*)(const std::filesystem::path& file);
/// Writes to a stream that throws when it cannot (OutputFile).
using WriteCloud = void (*)(std::ostream& out, const PointCloud& points, const CloudWriteOptions& options);

/// One way to store a cloud.
struct PointFormat {
  std::vector<std::string> extensions;
  ReadCloud read;
  WriteCloud write = nullptr;   ///< none: read only
  bool holds_georeference = false;  ///< else origin and CRS stand in a .georef.json beside
};

CloudFile read_las_cloud(const std::filesystem::path& file);
void write_las_cloud(std::ostream& out, const PointCloud& points, const CloudWriteOptions& options);
CloudFile read_pcd(const std::filesystem::path& file);
void write_pcd(std::ostream& out, const PointCloud& points, const CloudWriteOptions& options);
CloudFile read_ply(const std::filesystem::path& file);
void write_ply(std::ostream& out, const PointCloud& points, const CloudWriteOptions& options);
CloudFile read_xyz(const std::filesystem::path& file);
void write_xyz(std::ostream& out, const PointCloud& points, const CloudWriteOptions& options);

}  // namespace priormap
