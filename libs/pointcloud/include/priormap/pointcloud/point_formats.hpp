#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <priormap/core/atomic_output.hpp>
#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// A cloud as its file holds it.
struct CloudFile {
  PointCloud points;
  std::string crs;   ///< as the file or its .georef.json beside states it (WKT or "EPSG:..."); empty: none
};

enum class PcdEncoding { ascii, binary, binary_compressed };

struct CloudWriteOptions {
  std::string crs = {};                               ///< WKT1 for LAS; into .georef.json beside PCD, PLY and XYZ; empty: none
  PcdEncoding encoding = PcdEncoding::binary_compressed;   ///< PCD; PLY: ascii or binary
  double resolution_m = 0.001;                        ///< LAS scale
  Overwrite overwrite = Overwrite::refuse;
};

/// Reads .pcd .ply .las .xyz .txt .csv .bin (KITTI: 4 x float32) by extension. Clouds with a `.georef.json` beside get its origin
/// (positions = origin + file) and CRS. Fields of double or other numeric types are read right.
/// @throws FormatError, IoError
CloudFile read_point_cloud(const std::filesystem::path& file);

/// Writes by extension; PCD, PLY, XYZ hold positions relative to `points.origin` with the origin in `.georef.json` when the origin is
/// not zero or a CRS is given. Whole or not at all. @throws IoError, UsageError for an unknown extension.
void write_point_cloud(const std::filesystem::path& file, const PointCloud& points, const CloudWriteOptions& options = {});

/// "map.pcd" -> "map.pcd.georef.json"
std::filesystem::path georeference_path(const std::filesystem::path& file);

/// Extensions that can be read / written, for messages and --help.
const std::vector<std::string>& readable_cloud_extensions();
const std::vector<std::string>& writable_cloud_extensions();

}  // namespace priormap
