#pragma once
#include <filesystem>
#include <functional>

#include <pcl/PCLPointCloud2.h>

#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// PCL's table of typed fields as a cloud, each field converted by its own type.
PointCloud cloud_from_pcl(const pcl::PCLPointCloud2& table, const std::filesystem::path& file);
/// All columns of the cloud, positions relative to its origin, rows without padding.
pcl::PCLPointCloud2 pcl_from_cloud(const PointCloud& points);

/// Runs one of PCL's readers: silent, and every failure as a FormatError.
pcl::PCLPointCloud2 read_by_pcl(const std::filesystem::path& file, const std::function<int(pcl::PCLPointCloud2&)>& read);

}  // namespace priormap
