#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <priormap/pointcloud/point_cloud.hpp>

#include "formats/scalar_type.hpp"

namespace priormap {

/// A named value of each point, as PCD, PLY and text files hold them: every `stride` bytes one.
struct NamedColumn {
  std::string name;
  ScalarType type = ScalarType::float32;
  const std::byte* first = nullptr;
  std::size_t stride = 0;
};

/// The cloud that the columns describe: x, y, z; normal_x/y/z or nx/ny/nz; intensity; classification or class; sigma_m; source; feature; and
/// a time (time_s, time, t, timestamp, offset_time: integers are nanoseconds, floats seconds; epoch times count from the earliest point).
/// Names are compared without case; other columns are left out. The origin is zero, or the first point in whole units where coordinates
/// lie too far out for float32.
/// @throws FormatError when x, y or z is missing.
PointCloud cloud_from_columns(const std::vector<NamedColumn>& columns, std::size_t count, const std::filesystem::path& file);

/// One column of a cloud as it is written: its name and where its values are.
std::vector<NamedColumn> columns_of_cloud(const PointCloud& points);

}  // namespace priormap
