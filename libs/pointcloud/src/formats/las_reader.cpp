#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <priormap/core/error.hpp>
#include <priormap/pointcloud/las.hpp>

#include "formats/las_layout.hpp"
#include "formats/read_only_file.hpp"

namespace priormap {
namespace {

using namespace las;

constexpr std::size_t max_wkt_length = 1 << 20;

/// The file's bytes, from disk or from memory; views stay valid until the next call.
class ByteSource {
 public:
  explicit ByteSource(const std::filesystem::path& file) : file_(file), name_(file.string()), size_(file_->size()) {}
  ByteSource(std::vector<std::byte> bytes, std::string name) : name_(std::move(name)), size_(bytes.size()), bytes_(std::move(bytes)) {}

  std::uint64_t size() const { return size_; }
  [[noreturn]] void fail(const std::string& cause) const { throw FormatError(std::filesystem::path(name_), cause); }

  /// `length` must lie within the file from `position`.
  std::span<const std::byte> view(std::uint64_t position, std::size_t length) {
    if (!file_) return std::span(bytes_).subspan(position, length);
    if (bytes_.size() < length) bytes_.resize(length);
    file_->read(position, std::span(bytes_).first(length));
    return std::span(bytes_).first(length);
  }

 private:
  std::optional<ReadOnlyFile> file_;
  std::string name_;
  std::uint64_t size_;
  std::vector<std::byte> bytes_;  ///< the whole content, or the buffer of the last view
};

struct Layout {
  LasHeader header;
  std::uint64_t points_position = 0;
  std::size_t record_length = 0;
  std::vector<ExtraField> extra_fields;
};

std::string text(const std::byte* at, std::size_t max_length) {
  const char* begin = reinterpret_cast<const char*>(at);
  return std::string(begin, std::find(begin, begin + max_length, '\0'));
}

Eigen::Vector3d load_vector(const std::byte* at) { return {load<double>(at), load<double>(at + 8), load<double>(at + 16)}; }

void check_signature(const ByteSource& file, std::span<const std::byte> head) {
  if (head.size() < 104 || text(head.data(), 4) != "LASF") file.fail("is no LAS file (the signature LASF is missing)");
  const int major = load<std::uint8_t>(&head[24]), minor = load<std::uint8_t>(&head[25]);
  if (major != 1 || minor < 2 || minor > 4)
    file.fail("LAS " + std::to_string(major) + "." + std::to_string(minor) + " is not supported; versions 1.2 to 1.4 are");
}

int checked_point_format(const ByteSource& file, std::uint8_t stored) {
  if (stored & 0xc0) file.fail("is compressed (LAZ), which is not read; convert it, such as by: laszip -i in.laz -o out.las");
  if (base_record_length(stored) == 0)
    file.fail("LAS point format " + std::to_string(stored) + " is not supported; formats 0-3 and 6-8 are");
  return stored;
}

std::uint64_t stated_point_count(std::span<const std::byte> head, int version_minor) {
  const std::uint64_t legacy = load<std::uint32_t>(&head[107]);
  const std::uint64_t count = version_minor >= 4 ? load<std::uint64_t>(&head[247]) : 0;
  return count != 0 ? count : legacy;
}

/// The fixed part of the header, every promise of it checked against the file's size.
Layout read_fixed_header(ByteSource& file) {
  const auto head = file.view(0, std::min<std::uint64_t>(file.size(), header_size_1_4));
  check_signature(file, head);
  Layout layout;
  LasHeader& header = layout.header;
  header.version_minor = load<std::uint8_t>(&head[25]);
  const std::size_t needed = header.version_minor >= 4 ? header_size_1_4 : header.version_minor == 3 ? header_size_1_3 : header_size_1_2;
  const std::size_t header_size = load<std::uint16_t>(&head[94]);
  if (head.size() < needed) file.fail("is cut off inside the LAS header; fetch or copy it again");
  if (header_size < needed)
    file.fail("LAS header of " + std::to_string(header_size) + " bytes is too short for version 1." + std::to_string(header.version_minor));

  header.point_format = checked_point_format(file, load<std::uint8_t>(&head[104]));
  layout.record_length = load<std::uint16_t>(&head[105]);
  if (layout.record_length < base_record_length(header.point_format))
    file.fail("LAS records of " + std::to_string(layout.record_length) + " bytes are too short for point format " +
              std::to_string(header.point_format));
  layout.points_position = load<std::uint32_t>(&head[96]);
  if (layout.points_position < header_size || layout.points_position > file.size())
    file.fail("the LAS header places the points outside the file, at byte " + std::to_string(layout.points_position) + " of " +
              std::to_string(file.size()));

  header.num_points = stated_point_count(head, header.version_minor);
  const std::uint64_t held = (file.size() - layout.points_position) / layout.record_length;
  if (header.num_points > held)
    file.fail("is cut off: the LAS header promises " + std::to_string(header.num_points) + " points, the file has room for " +
              std::to_string(held) + "; fetch or copy it again");

  header.scale = load_vector(&head[131]);
  header.offset = load_vector(&head[155]);
  if (!header.scale.allFinite() || (header.scale.array() == 0).any() || !header.offset.allFinite())
    file.fail("LAS scale or offset is zero or no number");
  header.max = {load<double>(&head[179]), load<double>(&head[195]), load<double>(&head[211])};
  header.min = {load<double>(&head[187]), load<double>(&head[203]), load<double>(&head[219])};
  return layout;
}

struct Record {
  std::string user;
  std::uint16_t id = 0;
  std::uint64_t position = 0, length = 0;
};

std::vector<Record> list_variable_records(ByteSource& file, std::uint64_t points_position) {
  const auto head = file.view(0, header_size_1_2);
  const std::uint32_t count = load<std::uint32_t>(&head[100]);
  std::uint64_t position = load<std::uint16_t>(&head[94]);
  if (count > (points_position - position) / vlr_header_size)
    file.fail("the LAS header promises " + std::to_string(count) + " variable length records, more than fit before the points");
  std::vector<Record> records;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (position + vlr_header_size > points_position) file.fail("a LAS variable length record runs into the points");
    const auto at = file.view(position, vlr_header_size);
    Record record{text(&at[2], 16), load<std::uint16_t>(&at[18]), position + vlr_header_size, load<std::uint16_t>(&at[20])};
    position = record.position + record.length;
    if (position > points_position) file.fail("a LAS variable length record runs into the points");
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<Record> list_extended_records(ByteSource& file) {
  const auto head = file.view(0, header_size_1_4);
  std::uint64_t position = load<std::uint64_t>(&head[235]);
  const std::uint32_t count = load<std::uint32_t>(&head[243]);
  std::vector<Record> records;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (position > file.size() || file.size() - position < evlr_header_size)
      file.fail("a LAS extended record lies outside the file");
    const auto at = file.view(position, evlr_header_size);
    Record record{text(&at[2], 16), load<std::uint16_t>(&at[18]), position + evlr_header_size, load<std::uint64_t>(&at[20])};
    if (record.length > file.size() - record.position) file.fail("a LAS extended record lies outside the file");
    position = record.position + record.length;
    records.push_back(std::move(record));
  }
  return records;
}

/// "EPSG:h" or "EPSG:h+v" of GeoTIFF keys (OGC 19-008): ProjectedCRS 3072, else GeodeticCRS 2048; VerticalCRS 4096. Empty where user-defined.
std::string crs_of_geo_keys(std::span<const std::byte> record) {
  std::map<int, int> short_values;
  for (std::size_t at = 8; at + 8 <= record.size(); at += 8)
    if (load<std::uint16_t>(&record[at + 2]) == 0) short_values[load<std::uint16_t>(&record[at])] = load<std::uint16_t>(&record[at + 6]);
  const auto code = [&](int key) {
    const auto found = short_values.find(key);
    const bool is_epsg = found != short_values.end() && found->second >= 1024 && found->second < 32767;
    return is_epsg ? std::to_string(found->second) : std::string();
  };
  const bool user_defined_projection = short_values.contains(3072) && code(3072).empty();
  const std::string horizontal = short_values.contains(3072) ? code(3072) : code(2048), vertical = code(4096);
  if (horizontal.empty() || user_defined_projection) return {};
  return "EPSG:" + horizontal + (vertical.empty() ? "" : "+" + vertical);
}

std::string crs_of_records(ByteSource& file, const std::vector<Record>& records, bool prefer_wkt) {
  std::string wkt, geo_keys;
  for (const Record& record : records) {
    if (record.user != "LASF_Projection" || record.length == 0) continue;
    if (record.id == wkt_record && wkt.empty()) {
      if (record.length > max_wkt_length) file.fail("the LAS WKT record is larger than 1 MB");
      const auto bytes = file.view(record.position, record.length);
      wkt = text(bytes.data(), bytes.size());
    } else if (record.id == geo_keys_record && geo_keys.empty() && record.length <= 65535) {
      geo_keys = crs_of_geo_keys(file.view(record.position, record.length));
    }
  }
  if (prefer_wkt) return wkt.empty() ? geo_keys : wkt;
  return geo_keys.empty() ? wkt : geo_keys;
}

/// Deprecated two- and three-fold types 11-30 and opaque bytes (0) take room in the record but hold nothing for us.
std::size_t skipped_size(std::uint8_t type, std::uint8_t options) {
  if (type == 0) return options;
  const int members = type <= 20 ? 2 : 3;
  return static_cast<std::size_t>(members) * size_of(static_cast<ScalarType>((type - 1) % 10 + 1));
}

std::vector<ExtraField> parse_extra_bytes(ByteSource& file, const Record& record, const Layout& layout) {
  std::vector<ExtraField> fields;
  std::size_t position = base_record_length(layout.header.point_format);
  const auto bytes = file.view(record.position, record.length);
  for (std::size_t at = 0; at + extra_bytes_record_size <= bytes.size(); at += extra_bytes_record_size) {
    const std::byte* entry = &bytes[at];
    const auto type = load<std::uint8_t>(entry + 2), options = load<std::uint8_t>(entry + 3);
    if (type > 30) file.fail("LAS extra bytes of unknown type " + std::to_string(type));
    const bool is_number = type >= 1 && type <= 10;
    if (is_number) {
      ExtraField field{text(entry + 4, 32), static_cast<ScalarType>(type), 1, 0, std::nullopt, position};
      const bool is_float = type >= 9, is_signed = type % 2 == 0;
      if (options & 1)
        field.no_data = is_float    ? load<double>(entry + 40)
                        : is_signed ? static_cast<double>(load<std::int64_t>(entry + 40))
                                    : static_cast<double>(load<std::uint64_t>(entry + 40));
      if (options & 8) field.scale = load<double>(entry + 112);
      if (options & 16) field.offset = load<double>(entry + 136);
      fields.push_back(std::move(field));
    }
    position += is_number ? size_of(static_cast<ScalarType>(type)) : skipped_size(type, options);
  }
  if (position > layout.record_length)
    file.fail("the LAS extra bytes need records of " + std::to_string(position) + " bytes, the records have " +
              std::to_string(layout.record_length));
  return fields;
}

Layout read_layout(ByteSource& file) {
  Layout layout = read_fixed_header(file);
  const bool prefer_wkt = load<std::uint16_t>(&file.view(0, header_size_1_2)[6]) & wkt_encoding_bit;
  std::vector<Record> records = list_variable_records(file, layout.points_position);
  if (layout.header.version_minor >= 4) {
    auto extended = list_extended_records(file);
    std::move(extended.begin(), extended.end(), std::back_inserter(records));
  }
  layout.header.crs = crs_of_records(file, records, prefer_wkt);
  for (const Record& record : records) {
    if (record.user == "LASF_Spec" && record.id == extra_bytes_record && record.length <= 65535) {
      layout.extra_fields = parse_extra_bytes(file, record, layout);
      break;
    }
  }
  for (const ExtraField& field : layout.extra_fields) layout.header.extra_byte_names.push_back(field.name);
  return layout;
}

const ExtraField* find(const std::vector<ExtraField>& fields, std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const ExtraField& f) { return f.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

/// A block of point records in memory.
struct Records {
  const std::byte* first;
  std::size_t count, length;
  const std::byte* at(std::size_t i, std::size_t position) const { return first + i * length + position; }
};

/// Calls store(i, value) with the field's value of each point, scaled; values that mean "no data" come as `if_no_data`.
template <class Store>
void decode_extra(const Records& records, const ExtraField& field, double if_no_data, Store&& store_value) {
  const double no_data = field.no_data.value_or(std::numeric_limits<double>::quiet_NaN());
  with_type(field.type, [&](auto example) {
    using Value = decltype(example);
    for (std::size_t i = 0; i < records.count; ++i) {
      const double raw = static_cast<double>(load<Value>(records.at(i, field.position)));
      store_value(i, raw == no_data ? if_no_data : raw * field.scale + field.offset);
    }
  });
}

template <class Integer>
Integer clamped(double value) {
  constexpr double low = 0, high = static_cast<double>(std::numeric_limits<Integer>::max());
  return value > low ? static_cast<Integer>(std::min(value, high)) : Integer{0};
}

void decode_positions(const Records& records, const LasHeader& header, PointCloud& points) {
  const Eigen::Vector3d scale = header.scale, shift = header.offset - points.origin;
  for (std::size_t i = 0; i < records.count; ++i) {
    const std::byte* at = records.at(i, 0);
    points.xyz[i] = {static_cast<float>(load<std::int32_t>(at) * scale.x() + shift.x()),
                     static_cast<float>(load<std::int32_t>(at + 4) * scale.y() + shift.y()),
                     static_cast<float>(load<std::int32_t>(at + 8) * scale.z() + shift.z())};
  }
}

void decode_classes(const Records& records, int point_format, std::vector<std::uint8_t>& classes) {
  classes.resize(records.count);
  const bool extended = is_extended(point_format);
  const std::size_t position = extended ? 16 : 15;
  const unsigned mask = extended ? 0xff : 0x1f;  // formats 0-5 keep flags in the upper three bits
  for (std::size_t i = 0; i < records.count; ++i)
    classes[i] = static_cast<std::uint8_t>(load<std::uint8_t>(records.at(i, position)) & mask);
}

void decode_intensity(const Records& records, std::vector<float>& intensity) {
  intensity.resize(records.count);
  bool any = false;
  for (std::size_t i = 0; i < records.count; ++i) {
    intensity[i] = load<std::uint16_t>(records.at(i, 12));
    any |= intensity[i] != 0;
  }
  if (!any) intensity.clear();
}

void decode_normals(const Records& records, const std::vector<ExtraField>& fields, std::vector<Eigen::Vector3f>& normal) {
  for (const auto name : normal_names)
    if (!find(fields, name)) return;
  normal.resize(records.count);
  for (int axis = 0; axis < 3; ++axis)
    decode_extra(records, *find(fields, normal_names[static_cast<std::size_t>(axis)]), 0,
                 [&](std::size_t i, double v) { normal[i][axis] = static_cast<float>(v); });
}

void decode_columns(const Records& records, const std::vector<ExtraField>& fields, PointCloud& points) {
  decode_normals(records, fields, points.normal);
  const auto decode = [&](std::string_view name, auto& column, double if_no_data, auto convert) {
    const ExtraField* field = find(fields, name);
    if (!field) return;
    column.resize(records.count);
    decode_extra(records, *field, if_no_data, [&](std::size_t i, double v) { column[i] = convert(v); });
  };
  const auto to_float = [](double v) { return static_cast<float>(v); };
  decode(sigma_name, points.sigma_m, std::numeric_limits<double>::quiet_NaN(), to_float);
  decode(source_name, points.source, 0, clamped<std::uint16_t>);
  decode(feature_name, points.feature, PointCloud::no_feature, clamped<std::uint32_t>);
  decode(intensity_name, points.intensity, 0, to_float);
  decode(time_name, points.time_s, 0, to_float);
}

Eigen::Vector3d first_point_in_whole_units(const Records& records, const LasHeader& header) {
  Eigen::Vector3d p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = std::round(load<std::int32_t>(records.at(0, 4 * static_cast<std::size_t>(axis))) * header.scale[axis] + header.offset[axis]);
  return p;
}

}  // namespace

struct LasReader::Impl {
  explicit Impl(ByteSource source) : file(std::move(source)), layout(read_layout(file)) {}
  ByteSource file;
  Layout layout;
  std::uint64_t next_point = 0;
};

LasReader::LasReader(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(ByteSource(file))) {}
LasReader::LasReader(std::vector<std::byte> bytes, std::string name)
    : impl_(std::make_unique<Impl>(ByteSource(std::move(bytes), std::move(name)))) {}
LasReader::~LasReader() = default;
LasReader::LasReader(LasReader&&) noexcept = default;

const LasHeader& LasReader::header() const { return impl_->layout.header; }

bool LasReader::read(PointCloud& points, std::size_t max_points, const std::optional<Eigen::Vector3d>& origin) {
  const Layout& layout = impl_->layout;
  points.clear();
  const std::size_t count = std::min<std::uint64_t>(max_points, layout.header.num_points - impl_->next_point);
  if (count == 0) return false;

  const auto bytes = impl_->file.view(layout.points_position + impl_->next_point * layout.record_length, count * layout.record_length);
  const Records records{bytes.data(), count, layout.record_length};
  impl_->next_point += count;

  points.origin = origin ? *origin : first_point_in_whole_units(records, layout.header);
  points.xyz.resize(count);
  decode_positions(records, layout.header, points);
  decode_classes(records, layout.header.point_format, points.classification);
  decode_intensity(records, points.intensity);
  decode_columns(records, layout.extra_fields, points);
  return true;
}

}  // namespace priormap
