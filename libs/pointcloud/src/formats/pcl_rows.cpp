#include "formats/pcl_rows.hpp"

#include <pcl/console/print.h>

#include <optional>

#include <priormap/core/error.hpp>

#include "formats/named_columns.hpp"

namespace priormap {
namespace {

std::optional<ScalarType> scalar_type(std::uint8_t pcl_type) {
  using Field = pcl::PCLPointField;
  switch (pcl_type) {
    case Field::INT8: return ScalarType::int8;
    case Field::UINT8: return ScalarType::uint8;
    case Field::INT16: return ScalarType::int16;
    case Field::UINT16: return ScalarType::uint16;
    case Field::INT32: return ScalarType::int32;
    case Field::UINT32: return ScalarType::uint32;
    case Field::FLOAT32: return ScalarType::float32;
    case Field::FLOAT64: return ScalarType::float64;
    case Field::INT64: return ScalarType::int64;
    case Field::UINT64: return ScalarType::uint64;
    default: return std::nullopt;
  }
}

std::uint8_t pcl_type(ScalarType type) {
  using Field = pcl::PCLPointField;
  switch (type) {
    case ScalarType::uint8: return Field::UINT8;
    case ScalarType::uint16: return Field::UINT16;
    case ScalarType::uint32: return Field::UINT32;
    case ScalarType::float32: return Field::FLOAT32;
    default: throw Error("a cloud has no columns of this type");
  }
}

}  // namespace

PointCloud cloud_from_pcl(const pcl::PCLPointCloud2& table, const std::filesystem::path& file) {
  const std::size_t count = static_cast<std::size_t>(table.width) * table.height;
  if (table.data.size() < count * table.point_step) throw FormatError(file, "is cut off: it holds fewer points than its header promises");
  std::vector<NamedColumn> columns;
  for (const pcl::PCLPointField& field : table.fields) {
    const auto type = scalar_type(field.datatype);
    if (!type || field.count != 1) continue;
    if (field.offset + size_of(*type) > table.point_step) throw FormatError(file, "field '" + field.name + "' lies outside the points");
    columns.push_back({field.name, *type, reinterpret_cast<const std::byte*>(table.data.data()) + field.offset, table.point_step});
  }
  return cloud_from_columns(columns, count, file);
}

pcl::PCLPointCloud2 pcl_from_cloud(const PointCloud& points) {
  pcl::PCLPointCloud2 table;
  const auto columns = columns_of_cloud(points);
  for (const NamedColumn& column : columns) {
    pcl::PCLPointField field;
    field.name = column.name;
    field.offset = table.point_step;
    field.datatype = pcl_type(column.type);
    field.count = 1;
    table.fields.push_back(field);
    table.point_step += static_cast<std::uint32_t>(size_of(column.type));
  }
  table.height = 1;
  table.width = static_cast<std::uint32_t>(points.size());
  table.row_step = table.point_step * table.width;
  table.is_dense = true;
  table.data.resize(static_cast<std::size_t>(table.point_step) * points.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    auto* to = table.data.data() + table.fields[c].offset;
    const std::size_t size = size_of(columns[c].type);
    for (std::size_t i = 0; i < points.size(); ++i, to += table.point_step) std::memcpy(to, columns[c].first + i * columns[c].stride, size);
  }
  return table;
}

pcl::PCLPointCloud2 read_by_pcl(const std::filesystem::path& file, const std::function<int(pcl::PCLPointCloud2&)>& read) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // PCL prints to stdout otherwise
  pcl::PCLPointCloud2 table;
  try {
    if (read(table) < 0) throw FormatError(file, "cannot be read: its header or its points are broken");
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw FormatError(file, std::string("cannot be read: ") + error.what());
  }
  return table;
}

}  // namespace priormap
