#include "formats/named_columns.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string_view>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

/// Up to here float32 keeps 0.25 mm, so that clouds in a sensor's frame keep their zero origin.
constexpr double float32_reach = 4096;
/// Larger times are counted from some epoch, which float32 seconds cannot hold.
constexpr double largest_scan_time_s = 1e4;

using Columns = std::vector<NamedColumn>;

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

const NamedColumn* find(const Columns& columns, std::initializer_list<std::string_view> names) {
  for (const auto name : names)
    for (const NamedColumn& column : columns)
      if (lower_case(column.name) == name) return &column;
  return nullptr;
}

template <class Store>
void for_each_value(const NamedColumn& column, std::size_t count, Store&& store_value) {
  with_type(column.type, [&](auto example) {
    for (std::size_t i = 0; i < count; ++i) store_value(i, static_cast<double>(load<decltype(example)>(column.first + i * column.stride)));
  });
}

double value_at(const NamedColumn& column, std::size_t i) {
  double value = 0;
  for_each_value({column.name, column.type, column.first + i * column.stride, column.stride}, 1, [&](std::size_t, double v) { value = v; });
  return value;
}

/// Zero where float32 holds every coordinate well enough, else the first finite point in whole units.
Eigen::Vector3d choose_origin(const std::array<const NamedColumn*, 3>& axes, std::size_t count) {
  double reach = 0;
  for (const NamedColumn* axis : axes) {
    if (axis->type != ScalarType::float64) continue;
    for_each_value(*axis, count, [&](std::size_t, double v) {
      if (std::isfinite(v)) reach = std::max(reach, std::abs(v));
    });
  }
  if (reach <= float32_reach) return Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p(value_at(*axes[0], i), value_at(*axes[1], i), value_at(*axes[2], i));
    if (p.allFinite()) return p.array().round();
  }
  return Eigen::Vector3d::Zero();
}

void read_positions(const Columns& columns, std::size_t count, const std::filesystem::path& file, PointCloud& points) {
  const std::array<const NamedColumn*, 3> axes = {find(columns, {"x"}), find(columns, {"y"}), find(columns, {"z"})};
  for (const NamedColumn* axis : axes)
    if (!axis) throw FormatError(file, "has no fields x, y and z");
  points.origin = choose_origin(axes, count);
  points.xyz.resize(count);
  for (int axis = 0; axis < 3; ++axis) {
    const double shift = points.origin[axis];
    for_each_value(*axes[static_cast<std::size_t>(axis)], count,
                   [&](std::size_t i, double v) { points.xyz[i][axis] = static_cast<float>(v - shift); });
  }
}

void read_normals(const Columns& columns, std::size_t count, PointCloud& points) {
  const std::array<const NamedColumn*, 3> axes = {find(columns, {"normal_x", "nx"}), find(columns, {"normal_y", "ny"}),
                                                  find(columns, {"normal_z", "nz"})};
  if (!axes[0] || !axes[1] || !axes[2]) return;
  points.normal.resize(count);
  for (int axis = 0; axis < 3; ++axis)
    for_each_value(*axes[static_cast<std::size_t>(axis)], count, [&](std::size_t i, double v) { points.normal[i][axis] = static_cast<float>(v); });
}

template <class Value>
void read_column(const Columns& columns, std::initializer_list<std::string_view> names, std::size_t count, std::vector<Value>& values) {
  const NamedColumn* column = find(columns, names);
  if (!column) return;
  values.resize(count);
  for_each_value(*column, count, [&](std::size_t i, double v) {
    if constexpr (std::is_integral_v<Value>)
      values[i] = v > 0 ? static_cast<Value>(std::min<double>(v, std::numeric_limits<Value>::max())) : Value{0};
    else
      values[i] = static_cast<Value>(v);
  });
}

void read_times(const Columns& columns, std::size_t count, PointCloud& points) {
  const NamedColumn* column = find(columns, {"time_s", "time", "t", "timestamp", "offset_time"});
  if (!column) return;
  const double unit_s = column->type >= ScalarType::float32 ? 1 : 1e-9;
  double earliest = std::numeric_limits<double>::infinity();   // of those that count from an epoch: missing returns carry a zero among them
  for_each_value(*column, count, [&](std::size_t, double v) {
    if (v * unit_s > largest_scan_time_s) earliest = std::min(earliest, v);
  });
  const double start = std::isfinite(earliest) ? earliest : 0;
  points.time_s.resize(count);
  for_each_value(*column, count, [&](std::size_t i, double v) { points.time_s[i] = static_cast<float>((v - start) * unit_s); });
}

}  // namespace

PointCloud cloud_from_columns(const Columns& columns, std::size_t count, const std::filesystem::path& file) {
  PointCloud points;
  read_positions(columns, count, file, points);
  read_normals(columns, count, points);
  read_column(columns, {"intensity"}, count, points.intensity);
  read_column(columns, {"classification", "class"}, count, points.classification);
  read_column(columns, {"sigma_m"}, count, points.sigma_m);
  read_column(columns, {"source"}, count, points.source);
  read_column(columns, {"feature"}, count, points.feature);
  read_times(columns, count, points);
  return points;
}

Columns columns_of_cloud(const PointCloud& points) {
  Columns columns;
  const auto add_vectors = [&](const std::vector<Eigen::Vector3f>& vectors, std::initializer_list<const char*> names) {
    const auto* first = reinterpret_cast<const std::byte*>(vectors.data());
    for (const char* name : names) {
      columns.push_back({name, ScalarType::float32, first, sizeof(Eigen::Vector3f)});
      first += sizeof(float);
    }
  };
  const auto add = [&](const char* name, ScalarType type, const auto& values) {
    if (!values.empty()) columns.push_back({name, type, reinterpret_cast<const std::byte*>(values.data()), sizeof values[0]});
  };
  add_vectors(points.xyz, {"x", "y", "z"});
  if (!points.normal.empty()) add_vectors(points.normal, {"normal_x", "normal_y", "normal_z"});
  add("intensity", ScalarType::float32, points.intensity);
  add("classification", ScalarType::uint8, points.classification);
  add("sigma_m", ScalarType::float32, points.sigma_m);
  add("source", ScalarType::uint16, points.source);
  add("feature", ScalarType::uint32, points.feature);
  add("time_s", ScalarType::float32, points.time_s);
  return columns;
}

}  // namespace priormap
