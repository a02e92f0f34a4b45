#include <pcl/io/pcd_io.h>

#include <priormap/core/error.hpp>

#include "formats/header_lines.hpp"
#include "formats/named_columns.hpp"
#include "formats/pcl_rows.hpp"
#include "formats/point_format.hpp"
#include "formats/text_rows.hpp"

namespace priormap {
namespace {

/// LZF, which packs binary_compressed PCD, shrinks 264 bytes to 3 at best.
constexpr std::uint64_t best_lzf_ratio = 88;

struct PcdPromise {
  std::uint64_t num_points = 0, point_size = 0;
  std::uint64_t num_values = 0;  ///< a point
  std::string encoding;
};

PcdPromise parse_promise(const HeaderLines& header, const std::filesystem::path& file) {
  PcdPromise promise;
  std::vector<std::uint64_t> sizes, counts;
  for (const auto& words : header.lines) {
    const auto numbers = [&] {
      std::vector<std::uint64_t> values;
      for (std::size_t i = 1; i < words.size(); ++i) values.push_back(whole_number(words[i], file));
      return values;
    };
    if (words[0] == "SIZE") sizes = numbers();
    if (words[0] == "COUNT") counts = numbers();
    if (words[0] == "POINTS" && words.size() == 2) promise.num_points = numbers()[0];
    if (words[0] == "DATA" && words.size() == 2) promise.encoding = words[1];
  }
  if (counts.empty()) counts.assign(sizes.size(), 1);
  if (counts.size() != sizes.size()) throw FormatError(file, "is no usable PCD: SIZE and COUNT differ in length");
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sizes[i] > 8 || counts[i] > 65536) throw FormatError(file, "is no usable PCD: SIZE or COUNT is out of range");
    promise.point_size += sizes[i] * counts[i];
    promise.num_values += counts[i];
  }
  if (promise.point_size == 0) throw FormatError(file, "is no usable PCD: its header names no fields");
  return promise;
}

/// PCL allocates what the header promises: refuse what the file has no room for.
void check_promise(const std::filesystem::path& file) {
  const HeaderLines header = read_header_lines(file, "DATA");
  const PcdPromise promise = parse_promise(header, file);
  const std::uint64_t held = header.file_size - header.size;
  std::uint64_t room = 0;
  if (promise.encoding == "ascii") room = (held + 1) / (2 * promise.num_values);
  else if (promise.encoding == "binary") room = held / promise.point_size;
  else if (promise.encoding == "binary_compressed") room = held * best_lzf_ratio / promise.point_size;
  else throw FormatError(file, "is no usable PCD: DATA '" + promise.encoding + "' is unknown");
  if (promise.num_points > room)
    throw FormatError(file, "is cut off: its header promises " + std::to_string(promise.num_points) + " points, more than the file has room for");
}

}  // namespace

CloudFile read_pcd(const std::filesystem::path& file) {
  check_promise(file);
  const auto table = read_by_pcl(file, [&](pcl::PCLPointCloud2& read) { return pcl::PCDReader().read(file.string(), read); });
  return {cloud_from_pcl(table, file), {}};
}

void write_pcd(std::ostream& out, const PointCloud& points, const CloudWriteOptions& options) {
  const pcl::PCLPointCloud2 table = pcl_from_cloud(points);
  const Eigen::Vector4f no_translation = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf no_rotation = Eigen::Quaternionf::Identity();
  pcl::PCDWriter writer;
  if (options.encoding == PcdEncoding::binary_compressed && !points.empty()) {
    writer.writeBinaryCompressed(out, table, no_translation, no_rotation);
  } else if (options.encoding == PcdEncoding::ascii) {
    out << writer.generateHeaderASCII(table, no_translation, no_rotation) << "DATA ascii\n";
    write_text_rows(out, columns_of_cloud(points), points.size());
  } else {
    out << writer.generateHeaderBinary(table, no_translation, no_rotation) << "DATA binary\n";
    out.write(reinterpret_cast<const char*>(table.data.data()), static_cast<std::streamsize>(table.data.size()));
  }
}

}  // namespace priormap
