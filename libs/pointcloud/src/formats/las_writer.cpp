#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string>

#include <priormap/core/error.hpp>
#include <priormap/core/output_file.hpp>
#include <priormap/core/version.hpp>
#include <priormap/pointcloud/las.hpp>

#include "formats/las_layout.hpp"

namespace priormap {
namespace {

using namespace las;

constexpr double normal_steps = 32767, sigma_steps_per_m = 1000;
constexpr std::uint16_t unknown_sigma = LasPoint::unknown_sigma;

/// Which columns become extra bytes.
struct ExtraColumns {
  bool normal, sigma, source, feature, intensity, time;
};

// The LAS intensity field is a 16-bit integer; other values are kept beside it.
bool fits_las_intensity(float v) { return v >= 0 && v <= 65535 && v == static_cast<float>(static_cast<int>(v)); }

ExtraColumns extra_columns(const PointCloud& points) {
  return {!points.normal.empty(), !points.sigma_m.empty(), !points.source.empty(), !points.feature.empty(),
          !std::all_of(points.intensity.begin(), points.intensity.end(), fits_las_intensity), !points.time_s.empty()};
}

std::vector<ExtraField> plan_extra_fields(const ExtraColumns& columns, std::size_t base_length) {
  std::vector<ExtraField> fields;
  std::size_t position = base_length;
  const auto add = [&](std::string_view name, ScalarType type, double scale = 1, std::optional<double> no_data = std::nullopt) {
    fields.push_back({std::string(name), type, scale, 0, no_data, position});
    position += size_of(type);
  };
  if (columns.normal)
    for (const auto name : normal_names) add(name, ScalarType::int16, 1 / normal_steps);
  if (columns.sigma) add(sigma_name, ScalarType::uint16, 1 / sigma_steps_per_m, unknown_sigma);
  if (columns.source) add(source_name, ScalarType::uint16);
  if (columns.feature) add(feature_name, ScalarType::uint32, 1, PointCloud::no_feature);
  if (columns.intensity) add(intensity_name, ScalarType::float32);
  if (columns.time) add(time_name, ScalarType::float32);
  return fields;
}

const ExtraField* find(const std::vector<ExtraField>& fields, std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const ExtraField& f) { return f.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

/// Points [begin, end) of the cloud and where their records go. Columns are written block by block, so that a block stays in the cache.
struct RecordSink {
  std::byte* records;   ///< of point 0
  std::size_t length;
  std::size_t begin, end;
  std::byte* at(std::size_t i, std::size_t position) const { return records + i * length + position; }
};

constexpr std::size_t block_points = 1024;

/// To the nearest integer, ties to even, without a library call.
inline double nearest(double v) {
  constexpr double rounding = 6755399441055744.0;  // 1.5 * 2^52
  return (v + rounding) - rounding;
}

struct Extent {
  Eigen::Array3d min = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d max = Eigen::Array3d::Constant(-std::numeric_limits<double>::infinity());
};

/// Positions as multiples of the scale; widens `extent`, in multiples.
void encode_positions(const PointCloud& points, const LasWriteOptions& options, const RecordSink& sink, Extent& extent) {
  const Eigen::Array3d steps = options.scale.array().inverse(), shift = (points.origin - options.offset).array();
  for (std::size_t i = sink.begin; i < sink.end; ++i) {
    std::byte* at = sink.at(i, 0);
    for (int axis = 0; axis < 3; ++axis) {
      const double q = nearest((static_cast<double>(points.xyz[i][axis]) + shift[axis]) * steps[axis]);
      if (!(q >= -2147483648.0 && q <= 2147483647.0)) {
        if (std::isnan(q)) throw UsageError("LAS cannot hold a position that is no number");
        throw UsageError("positions lie too far from the LAS offset for the scale (32 bits); choose an offset near the points");
      }
      extent.min[axis] = std::min(extent.min[axis], q);
      extent.max[axis] = std::max(extent.max[axis], q);
      store(at + 4 * axis, static_cast<std::int32_t>(q));
    }
  }
}

void encode_standard_fields(const PointCloud& points, int point_format, const RecordSink& sink) {
  const bool extended = is_extended(point_format);
  const std::byte only_return{static_cast<unsigned char>(extended ? 0x11 : 0x09)};  // return 1 of 1
  const std::size_t class_position = extended ? 16 : 15;
  for (std::size_t i = sink.begin; i < sink.end; ++i) *sink.at(i, 14) = only_return;
  if (!points.intensity.empty())
    for (std::size_t i = sink.begin; i < sink.end; ++i) {
      const double whole = nearest(points.intensity[i]);
      store(sink.at(i, 12), static_cast<std::uint16_t>(whole > 0 ? std::min(whole, 65535.0) : 0.0));
    }
  if (points.classification.empty()) return;
  for (std::size_t i = sink.begin; i < sink.end; ++i) {
    if (!extended && points.classification[i] > 31)
      throw UsageError("class " + std::to_string(points.classification[i]) + " needs LAS point format 6, 7 or 8");
    store(sink.at(i, class_position), points.classification[i]);
  }
}

void encode_normals(const PointCloud& points, const std::vector<ExtraField>& fields, const RecordSink& sink) {
  const ExtraField* first = find(fields, normal_names[0]);
  if (!first) return;
  const auto steps = [](float v) { return static_cast<std::int16_t>(v >= -1 && v <= 1 ? nearest(v * normal_steps) : v > 1 ? normal_steps : v < -1 ? -normal_steps : 0); };
  for (std::size_t i = sink.begin; i < sink.end; ++i) {
    std::byte* at = sink.at(i, first->position);
    for (int axis = 0; axis < 3; ++axis) store(at + 2 * axis, steps(points.normal[i][axis]));
  }
}

std::uint16_t sigma_steps(float sigma_m) {
  const double steps = static_cast<double>(sigma_m) * sigma_steps_per_m;
  return steps >= 0 ? static_cast<std::uint16_t>(nearest(std::min(steps, unknown_sigma - 1.0))) : unknown_sigma;
}

void encode_columns(const PointCloud& points, const std::vector<ExtraField>& fields, const RecordSink& sink) {
  encode_normals(points, fields, sink);
  const auto encode = [&](std::string_view name, const auto& column, auto convert) {
    const ExtraField* field = find(fields, name);
    if (!field) return;
    for (std::size_t i = sink.begin; i < sink.end; ++i) store(sink.at(i, field->position), convert(column[i]));
  };
  const auto as_is = [](auto v) { return v; };
  encode(sigma_name, points.sigma_m, sigma_steps);
  encode(source_name, points.source, as_is);
  encode(feature_name, points.feature, as_is);
  encode(intensity_name, points.intensity, as_is);
  encode(time_name, points.time_s, as_is);
}

void put_text(std::byte* at, std::string_view text, std::size_t room) { std::memcpy(at, text.data(), std::min(text.size(), room)); }

/// One entry of the Extra Bytes record (table 23).
void put_extra_entry(std::byte* at, const ExtraField& field) {
  store(at + 2, static_cast<std::uint8_t>(field.type));
  store(at + 3, static_cast<std::uint8_t>((field.no_data ? 1 : 0) | (field.scale != 1 ? 8 : 0)));
  put_text(at + 4, field.name, 32);
  if (field.no_data) store(at + 40, static_cast<std::uint64_t>(*field.no_data));
  if (field.scale != 1) store(at + 112, field.scale);
}

struct VariableRecord {
  std::string user;
  std::uint16_t id;
  std::string description;
  std::vector<std::byte> content;
};

std::vector<VariableRecord> plan_variable_records(const std::string& wkt, const std::vector<ExtraField>& fields) {
  std::vector<VariableRecord> records;
  if (!wkt.empty()) {
    if (wkt.size() >= 65535) throw UsageError("the WKT of the CRS is too long for a LAS record");
    std::vector<std::byte> content(wkt.size() + 1);
    put_text(content.data(), wkt, wkt.size());
    records.push_back({"LASF_Projection", wkt_record, "OGC WKT", std::move(content)});
  }
  if (!fields.empty()) {
    std::vector<std::byte> content(fields.size() * extra_bytes_record_size);
    for (std::size_t i = 0; i < fields.size(); ++i) put_extra_entry(&content[i * extra_bytes_record_size], fields[i]);
    records.push_back({"LASF_Spec", extra_bytes_record, "Extra bytes", std::move(content)});
  }
  return records;
}

void put_variable_record(std::byte* at, const VariableRecord& record) {
  put_text(at + 2, record.user, 16);
  store(at + 18, record.id);
  store(at + 20, static_cast<std::uint16_t>(record.content.size()));
  put_text(at + 22, record.description, 32);
  std::memcpy(at + vlr_header_size, record.content.data(), record.content.size());
}

/// Day of the year and year of SOURCE_DATE_EPOCH (reproducible-builds.org); zeros without it.
void put_creation_date(std::byte* at) {
  const char* epoch = std::getenv("SOURCE_DATE_EPOCH");
  if (!epoch) return;
  const std::chrono::sys_days day = std::chrono::floor<std::chrono::days>(std::chrono::sys_seconds(std::chrono::seconds(std::atoll(epoch))));
  const std::chrono::year_month_day date(day);
  const std::chrono::sys_days new_year = date.year() / std::chrono::January / 1;
  store(at, static_cast<std::uint16_t>((day - new_year).count() + 1));
  store(at + 2, static_cast<std::uint16_t>(static_cast<int>(date.year())));
}

struct HeaderFacts {
  std::size_t points_position, record_length, num_variable_records, num_points;
  Extent extent;
};

void put_header(std::byte* at, const LasWriteOptions& options, const HeaderFacts& facts) {
  const bool extended = is_extended(options.point_format);
  put_text(at, "LASF", 4);
  if (extended) store(at + 6, wkt_encoding_bit);
  store(at + 24, std::uint8_t{1});
  store(at + 25, static_cast<std::uint8_t>(extended ? 4 : 2));
  put_text(at + 26, "priormap", 32);
  put_text(at + 58, "priormap " + std::string(version), 32);
  put_creation_date(at + 90);
  store(at + 94, static_cast<std::uint16_t>(extended ? header_size_1_4 : header_size_1_2));
  store(at + 96, static_cast<std::uint32_t>(facts.points_position));
  store(at + 100, static_cast<std::uint32_t>(facts.num_variable_records));
  store(at + 104, static_cast<std::uint8_t>(options.point_format));
  store(at + 105, static_cast<std::uint16_t>(facts.record_length));
  if (extended) {
    store(at + 247, static_cast<std::uint64_t>(facts.num_points));
    store(at + 255, static_cast<std::uint64_t>(facts.num_points));  // all are first returns
  } else {
    store(at + 107, static_cast<std::uint32_t>(facts.num_points));
    store(at + 111, static_cast<std::uint32_t>(facts.num_points));
  }
  for (int axis = 0; axis < 3; ++axis) {
    store(at + 131 + 8 * axis, options.scale[axis]);
    store(at + 155 + 8 * axis, options.offset[axis]);
    if (facts.num_points == 0) continue;
    store(at + 179 + 16 * axis, facts.extent.max[axis] * options.scale[axis] + options.offset[axis]);
    store(at + 187 + 16 * axis, facts.extent.min[axis] * options.scale[axis] + options.offset[axis]);
  }
}

void check(std::size_t num_points, const LasWriteOptions& options) {
  if (base_record_length(options.point_format) == 0)
    throw UsageError("LAS point format " + std::to_string(options.point_format) + " is not supported; formats 0-3 and 6-8 are");
  if (!is_extended(options.point_format) && !options.wkt.empty())
    throw UsageError("LAS 1.2 holds no WKT; use point format 6, 7 or 8");
  if (!is_extended(options.point_format) && num_points > std::numeric_limits<std::uint32_t>::max())
    throw UsageError("LAS 1.2 holds at most 4294967295 points; use point format 6, 7 or 8");
  if (!options.scale.allFinite() || (options.scale.array() <= 0).any() || !options.offset.allFinite())
    throw UsageError("LAS scale must be positive and the offset finite");
}

/// What comes before the point records, but for the header's fields that depend on them.
struct FilePlan {
  std::vector<ExtraField> fields;
  HeaderFacts facts{};
  std::vector<std::byte> head;
};

FilePlan plan_file(std::size_t num_points, const ExtraColumns& columns, const LasWriteOptions& options) {
  check(num_points, options);
  FilePlan plan{plan_extra_fields(columns, base_record_length(options.point_format)), {}, {}};
  const auto variable_records = plan_variable_records(options.wkt, plan.fields);
  plan.facts.num_points = num_points;
  plan.facts.num_variable_records = variable_records.size();
  plan.facts.record_length = plan.fields.empty() ? base_record_length(options.point_format) : plan.fields.back().position + size_of(plan.fields.back().type);
  plan.head.resize(is_extended(options.point_format) ? header_size_1_4 : header_size_1_2);
  for (const auto& record : variable_records) {
    const std::size_t position = plan.head.size();
    plan.head.resize(position + vlr_header_size + record.content.size());
    put_variable_record(&plan.head[position], record);
  }
  plan.facts.points_position = plan.head.size();
  return plan;
}

struct LatticeSurvey {
  Eigen::AlignedBox3i extent;
  bool whole_intensities = true;
};

LatticeSurvey survey(std::span<const LasPoint> points) {
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  std::int32_t low[3] = {most, most, most}, high[3] = {-most, -most, -most};
  bool whole = true;
  for (const LasPoint& p : points) {
    const std::int32_t position[3] = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], position[axis]);
      high[axis] = std::max(high[axis], position[axis]);
    }
    whole = whole && (p.intensity == 0 || fits_las_intensity(p.intensity));
  }
  return {{Eigen::Vector3i(low), Eigen::Vector3i(high)}, whole};
}

static_assert(offsetof(LasPoint, sigma_mm) == offsetof(LasPoint, normal) + 6 && offsetof(LasPoint, source) == offsetof(LasPoint, normal) + 8, "as extra bytes follow each other");

/// All columns of a point in one go; the four extra columns follow each other in every plan. What is not set stays zero.
void encode_lattice_points(std::span<const LasPoint> points, bool extended, const FilePlan& plan, std::byte* records) {
  const std::byte only_return{static_cast<unsigned char>(extended ? 0x11 : 0x09)};
  const std::size_t class_position = extended ? 16 : 15, extra_position = plan.fields.front().position, length = plan.facts.record_length;
  const ExtraField* intensity = find(plan.fields, intensity_name);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LasPoint& p = points[i];
    std::byte* at = records + i * length;
    std::memcpy(at, &p.x, 12);
    store(at + 12, static_cast<std::uint16_t>(p.intensity == 0 ? 0.0f : std::clamp(p.intensity, 0.0f, 65535.0f) + 0.5f));
    at[14] = only_return;
    store(at + class_position, p.classification);
    store(at + 17, p.user_data);
    std::memcpy(at + extra_position, p.normal, 10);   // with sigma and source
    store(at + extra_position + 10, p.feature);
    if (intensity) store(at + intensity->position, p.intensity);
  }
}

}  // namespace

std::vector<std::byte> encode_las(const PointCloud& points, const LasWriteOptions& options) {
  points.check_columns();
  FilePlan plan = plan_file(points.size(), extra_columns(points), options);
  std::vector<std::byte> bytes = std::move(plan.head);
  bytes.resize(plan.facts.points_position + points.size() * plan.facts.record_length);
  for (std::size_t begin = 0; begin < points.size(); begin += block_points) {
    const RecordSink block{bytes.data() + plan.facts.points_position, plan.facts.record_length, begin, std::min(begin + block_points, points.size())};
    encode_positions(points, options, block, plan.facts.extent);
    encode_standard_fields(points, options.point_format, block);
    encode_columns(points, plan.fields, block);
  }
  put_header(bytes.data(), options, plan.facts);
  return bytes;
}

Eigen::AlignedBox3i encode_las(std::span<const LasPoint> points, const LasWriteOptions& options, const std::function<void(std::span<const std::byte>)>& write) {
  const LatticeSurvey facts = survey(points);
  FilePlan plan = plan_file(points.size(), {true, true, true, true, !facts.whole_intensities, false}, options);
  plan.facts.extent = {facts.extent.min().array().cast<double>(), facts.extent.max().array().cast<double>()};
  put_header(plan.head.data(), options, plan.facts);
  write(plan.head);
  std::vector<std::byte> records(std::min(points.size(), 2 * block_points) * plan.facts.record_length);
  for (; !points.empty(); points = points.subspan(std::min(points.size(), 2 * block_points))) {
    const auto block = points.first(std::min(points.size(), 2 * block_points));
    encode_lattice_points(block, is_extended(options.point_format), plan, records.data());
    write(std::span(records).first(block.size() * plan.facts.record_length));
  }
  return facts.extent;
}

void write_las(const std::filesystem::path& file, const PointCloud& points, const LasWriteOptions& options) {
  const std::vector<std::byte> bytes = encode_las(points, options);
  OutputFile out(file);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
}

}  // namespace priormap
