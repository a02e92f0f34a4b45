#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
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
  Eigen::Vector3d min = Eigen::Vector3d::Zero(), max = Eigen::Vector3d::Zero();  ///< as the file states them, not checked
  std::uint64_t num_points = 0;                                                  ///< never more than the file's size allows
  std::string crs;                            ///< WKT record, or "EPSG:h", "EPSG:h+v" where the GeoTIFF keys say so; empty: none
  std::vector<std::string> extra_byte_names;
};

/// Reads LAS 1.2 to 1.4, point formats 0-3 and 6-8, block by block. Compressed files (LAZ) are refused by name. What the header
/// promises is checked against the file's size before anything is allocated.
class LasReader {
 public:
  /// @throws IoError, FormatError
  explicit LasReader(const std::filesystem::path& file);
  /// A whole file in memory; `name` is for messages.
  LasReader(std::vector<std::byte> bytes, std::string name);
  ~LasReader();
  LasReader(LasReader&&) noexcept;

  const LasHeader& header() const;
  /// Replaces `points` by the next at most `max_points` points; false when there are none left.
  /// Positions are relative to `origin`; default: the first point of the block, in whole units.
  /// Columns filled: classification always; intensity where one is not zero; normal, sigma_m, source, feature, time_s where
  /// extra bytes of these names (docs/file-formats.md) are there.
  bool read(PointCloud& points, std::size_t max_points, const std::optional<Eigen::Vector3d>& origin = std::nullopt);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct LasWriteOptions {
  int point_format = 6;                              ///< 6-8: LAS 1.4; 0-3: LAS 1.2
  Eigen::Vector3d scale = Eigen::Vector3d::Constant(0.001);
  /// Coordinates are stored as 32-bit multiples of `scale` from here.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  std::string wkt = {};                              ///< WKT1, written as the OGC WKT record; formats 6-8 only
};

/// The bytes of a LAS file with all columns that `points` has; the layout of the extra bytes is described in docs/file-formats.md.
/// The creation date comes from SOURCE_DATE_EPOCH, or is 0: same points, same bytes.
/// @throws UsageError for a position that is not finite or does not fit into 32 bits, or an option that the point format cannot hold.
std::vector<std::byte> encode_las(const PointCloud& points, const LasWriteOptions& options);

/// One point with all of priormap's columns, as the file stores them: positions in multiples of the scale from the offset.
struct LasPoint {
  std::int32_t x = 0, y = 0, z = 0;
  std::int16_t normal[3] = {0, 0, 0};   ///< 1/32767; zero: unknown
  std::uint16_t sigma_mm = unknown_sigma;
  std::uint16_t source = 0;
  std::uint8_t classification = 0;
  std::uint8_t user_data = 0;
  std::uint32_t feature = PointCloud::no_feature;
  float intensity = 0;

  static constexpr std::uint16_t unknown_sigma = 65535;

  static std::int16_t normal_steps(float component) {
    const float steps = std::clamp(component, -1.0f, 1.0f) * 32767;
    return std::int16_t(steps + std::copysign(0.5f, steps));   // signs are random: no branch
  }
  void set_normal(const Eigen::Vector3f& unit) {
    for (int a = 0; a < 3; ++a) normal[a] = normal_steps(unit[a]);
  }
  /// NaN: unknown.
  void set_sigma(float sigma_m) {
    const double mm = double(sigma_m) * 1000.0 + 0.5;
    sigma_mm = mm >= 0 ? std::uint16_t(std::min(mm, unknown_sigma - 1.0)) : unknown_sigma;
  }
};
static_assert(sizeof(LasPoint) == 32);

/// The same for points that lie on the file's lattice already: much faster, and handed on from start to end in blocks of some 90 kB.
/// @return the positions' extent, in multiples of the scale
Eigen::AlignedBox3i encode_las(std::span<const LasPoint> points, const LasWriteOptions& options, const std::function<void(std::span<const std::byte>)>& write);

/// Plain write of `encode_las`: callers put it inside an AtomicFile or AtomicDirectory. @throws IoError, on a full disk as well.
void write_las(const std::filesystem::path& file, const PointCloud& points, const LasWriteOptions& options);

}  // namespace priormap
