#include <pcl/io/ply_io.h>

#include <map>

#include <priormap/core/error.hpp>

#include "formats/header_lines.hpp"
#include "formats/named_columns.hpp"
#include "formats/pcl_rows.hpp"
#include "formats/point_format.hpp"
#include "formats/text_rows.hpp"

namespace priormap {
namespace {

std::uint64_t size_of_ply_type(const std::string& type, const std::filesystem::path& file) {
  static const std::map<std::string, std::uint64_t> sizes = {
      {"char", 1},  {"uchar", 1},  {"int8", 1},  {"uint8", 1},  {"short", 2}, {"ushort", 2}, {"int16", 2},  {"uint16", 2},
      {"int", 4},   {"uint", 4},   {"int32", 4}, {"uint32", 4}, {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = sizes.find(type);
  if (found == sizes.end()) throw FormatError(file, "is no usable PLY: property type '" + type + "' is unknown");
  return found->second;
}

/// PCL allocates what the header promises: refuse what the file has no room for.
void check_promise(const std::filesystem::path& file) {
  const HeaderLines header = read_header_lines(file, "end_header");
  if (header.lines[0][0] != "ply") throw FormatError(file, "is no PLY file");
  std::uint64_t num_points = 0, point_size = 0, num_values = 0;
  bool in_vertex = false, is_ascii = false;
  for (const auto& words : header.lines) {
    if (words[0] == "format" && words.size() > 1) is_ascii = words[1] == "ascii";
    if (words[0] == "element" && words.size() == 3) {
      in_vertex = words[1] == "vertex";
      if (in_vertex) num_points = whole_number(words[2], file);
    }
    if (words[0] == "property" && in_vertex) {
      if (words.size() != 3) throw FormatError(file, "is no usable PLY: lists as vertex properties are not supported");
      point_size += size_of_ply_type(words[1], file);
      ++num_values;
    }
  }
  if (num_values == 0) throw FormatError(file, "is no usable PLY: it has no vertices with properties");
  const std::uint64_t held = header.file_size - header.size;
  if (num_points > (is_ascii ? (held + 1) / (2 * num_values) : held / point_size))
    throw FormatError(file, "is cut off: its header promises " + std::to_string(num_points) + " points, more than the file has room for");
}

}  // namespace

CloudFile read_ply(const std::filesystem::path& file) {
  check_promise(file);
  const auto table = read_by_pcl(file, [&](pcl::PCLPointCloud2& read) { return pcl::PLYReader().read(file.string(), read); });
  return {cloud_from_pcl(table, file), {}};
}

void write_ply(std::ostream& out, const PointCloud& points, const CloudWriteOptions& options) {
  const pcl::PCLPointCloud2 table = pcl_from_cloud(points);
  const Eigen::Vector4f no_translation = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf no_rotation = Eigen::Quaternionf::Identity();
  const int count = static_cast<int>(points.size());
  pcl::PLYWriter writer;
  if (options.encoding == PcdEncoding::ascii) {
    out << writer.generateHeaderASCII(table, no_translation, no_rotation, count, false);
    write_text_rows(out, columns_of_cloud(points), points.size());
  } else {
    out << writer.generateHeaderBinary(table, no_translation, no_rotation, count, false);
    out.write(reinterpret_cast<const char*>(table.data.data()), static_cast<std::streamsize>(table.data.size()));
  }
}

}  // namespace priormap
