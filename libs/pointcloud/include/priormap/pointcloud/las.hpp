#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// What priormap uses of a LAS header (ASPRS LAS 1.2 to 1.4 R15).
struct LasHeader {
  int version_minor = 4;
  int point_format = 6;
  Eigen::Vector3d scale = Eigen::Vector3d::Constant(0.001);
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d min = Eigen::Vector3d::Zero(), max = Eigen::Vector3d::Zero();
  std::uint64_t num_points = 0;
  std::string wkt;                                  ///< WKT record or, where GeoTIFF keys give an EPSG code, "EPSG:n"; empty: none
  std::vector<std::string> extra_byte_names;
};

/// Reads LAS 1.2 to 1.4, point formats 0-3 and 6-8, block by block. LAZ is refused by name.
class LasReader {
 public:
  /// @throws IoError, FormatError
  explicit LasReader(const std::filesystem::path& file);
  ~LasReader();
  const LasHeader& header() const;
  /// Next at most `max_points` points, positions relative to `header().offset`-near origin; false at the end.
  /// Columns filled: classification, intensity where any is non-zero, and normal, sigma_m, source, feature from extra bytes named so.
  bool read(PointCloud& points, std::size_t max_points);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct LasWriteOptions {
  int point_format = 6;                              ///< 6-8: LAS 1.4; 0-3: LAS 1.2
  Eigen::Vector3d scale = Eigen::Vector3d::Constant(0.001);
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  std::string wkt;                                   ///< WKT1; written as the OGC WKT record (formats 6-8)
};

/// Writes all columns that `points` has; extra bytes NormalX/Y/Z (float32... int16 scaled), Sigma, Source, Feature, as described in
/// docs/file-formats.md. Creation date from SOURCE_DATE_EPOCH or 0. Plain write: callers put it inside an AtomicFile/Directory.
/// @throws IoError on a full disk as well.
void write_las(const std::filesystem::path& file, const PointCloud& points, const LasWriteOptions& options);

}  // namespace priormap
