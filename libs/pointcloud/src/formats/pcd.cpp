#include <pcl/io/pcd_io.h>

#include <map>
#include <set>

#include <array>
#include <span>

#include <priormap/core/error.hpp>

#include "formats/header_lines.hpp"
#include "formats/named_columns.hpp"
#include "formats/pcl_rows.hpp"
#include "formats/point_format.hpp"
#include "formats/read_only_file.hpp"
#include "formats/text_rows.hpp"

namespace priormap {
namespace {

/// LZF, which packs binary_compressed PCD, shrinks 264 bytes to 3 at best.
constexpr std::uint64_t best_lzf_ratio = 88;
/// PCL counts points in 32 bits.
constexpr std::uint64_t max_points = 0xffffffff;

struct PcdPromise {
  std::uint64_t num_points = 0, point_size = 0;
  std::uint64_t num_values = 0;  ///< a point
  std::string encoding;
};

bool is_number_type(const std::string& type, std::uint64_t size) {
  return type == "F" ? size == 4 || size == 8 : (type == "I" || type == "U") && (size == 1 || size == 2 || size == 4 || size == 8);
}

using HeaderWords = std::map<std::string, std::vector<std::string>>;

/// What follows each keyword. PCL goes on with half a header where it meets a line it does not know, and then reads where nothing is.
HeaderWords words_by_keyword(const HeaderLines& header, const std::filesystem::path& file) {
  static const std::set<std::string> keywords = {"VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
  HeaderWords words_of;
  for (const auto& words : header.lines) {
    if (words[0].starts_with('#')) continue;
    if (!keywords.contains(words[0])) throw FormatError(file, "is no usable PCD: '" + words[0].substr(0, 40) + "' is no line of its header");
    if (!words_of.emplace(words[0], std::vector<std::string>(words.begin() + 1, words.end())).second)
      throw FormatError(file, "is no usable PCD: " + words[0] + " stands twice in its header");
  }
  if (words_of.contains("COLUMNS")) words_of["FIELDS"] = words_of["COLUMNS"];
  for (const char* needed : {"FIELDS", "SIZE", "TYPE", "WIDTH", "HEIGHT", "POINTS", "DATA"})
    if (words_of[needed].empty()) throw FormatError(file, std::string("is no usable PCD: ") + needed + " is missing in its header");
  return words_of;
}

PcdPromise parse_promise(const HeaderLines& header, const std::filesystem::path& file) {
  const HeaderWords words_of = words_by_keyword(header, file);
  const auto numbers = [&](const char* keyword) {
    std::vector<std::uint64_t> values;
    for (const std::string& word : words_of.at(keyword)) values.push_back(whole_number(word, file));
    return values;
  };
  const std::vector<std::uint64_t> sizes = numbers("SIZE");
  const std::vector<std::uint64_t> counts = words_of.contains("COUNT") ? numbers("COUNT") : std::vector<std::uint64_t>(sizes.size(), 1);
  const std::vector<std::string>& types = words_of.at("TYPE");
  if (counts.size() != sizes.size() || types.size() != sizes.size() || words_of.at("FIELDS").size() != sizes.size())
    throw FormatError(file, "is no usable PCD: FIELDS, SIZE, TYPE and COUNT differ in length");
  PcdPromise promise{.num_points = numbers("POINTS")[0], .encoding = words_of.at("DATA")[0]};
  const std::uint64_t width = numbers("WIDTH")[0], height = numbers("HEIGHT")[0];
  if (width > max_points || height > max_points || width * height != promise.num_points || promise.num_points > max_points)
    throw FormatError(file, "is no usable PCD: WIDTH times HEIGHT is not POINTS");
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (!is_number_type(types[i], sizes[i]) || counts[i] == 0 || counts[i] > 65536)
      throw FormatError(file, "is no usable PCD: SIZE, TYPE or COUNT of field " + std::to_string(i + 1) + " is out of range");
    promise.point_size += sizes[i] * counts[i];
    promise.num_values += counts[i];
  }
  return promise;
}

/// Before compressed points stand their size as packed and unpacked, two words that PCL believes.
void check_packed_size(const std::filesystem::path& file, const HeaderLines& header, const PcdPromise& promise) {
  if (promise.num_points == 0) return;
  std::array<std::uint32_t, 2> sizes{};
  if (header.file_size - header.size >= sizeof sizes) ReadOnlyFile(file).read(header.size, std::as_writable_bytes(std::span(sizes)));
  const auto [packed, unpacked] = sizes;
  if (packed == 0 || packed > header.file_size - header.size - sizeof sizes)
    throw FormatError(file, "is cut off: it holds fewer compressed bytes than it promises");
  if (unpacked != promise.num_points * promise.point_size)
    throw FormatError(file, "is no usable PCD: its compressed points are not as large as its header says");
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
  if (promise.encoding == "binary_compressed") check_packed_size(file, header, promise);
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
