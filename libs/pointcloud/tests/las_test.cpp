#include <priormap/pointcloud/las.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include <priormap/core/error.hpp>

#include "test_support.hpp"

namespace priormap {
namespace {

using Bytes = std::vector<std::byte>;

template <class T>
void put(Bytes& bytes, std::size_t at, T value) {
  if (bytes.size() < at + sizeof value) bytes.resize(at + sizeof value);
  std::memcpy(&bytes[at], &value, sizeof value);
}

template <class T>
T get(const Bytes& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, &bytes[at], sizeof value);
  return value;
}

/// A LAS file laid out by hand from the specification's tables, not by our writer.
struct HandMade {
  int minor = 2, format = 1;
  std::size_t header_size = 227, record_length = 28;
  Bytes variable_records;
  std::uint32_t num_variable_records = 0;

  void add_record(const char* user, std::uint16_t id, const Bytes& content) {
    const std::size_t at = variable_records.size();
    variable_records.resize(at + 54 + content.size());
    std::memcpy(&variable_records[at + 2], user, std::strlen(user));
    put(variable_records, at + 18, id);
    put(variable_records, at + 20, static_cast<std::uint16_t>(content.size()));
    std::memcpy(variable_records.data() + at + 54, content.data(), content.size());
    ++num_variable_records;
  }

  Bytes bytes(const std::vector<Bytes>& records) const {
    Bytes file(header_size);
    std::memcpy(file.data(), "LASF", 4);
    put(file, 24, std::uint8_t{1});
    put(file, 25, static_cast<std::uint8_t>(minor));
    put(file, 94, static_cast<std::uint16_t>(header_size));
    put(file, 96, static_cast<std::uint32_t>(header_size + variable_records.size()));
    put(file, 100, num_variable_records);
    put(file, 104, static_cast<std::uint8_t>(format));
    put(file, 105, static_cast<std::uint16_t>(record_length));
    if (minor < 4) put(file, 107, static_cast<std::uint32_t>(records.size()));
    if (minor >= 4) put(file, 247, static_cast<std::uint64_t>(records.size()));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(file, 131 + 8 * axis, 0.01);
      put(file, 155 + 8 * axis, 1000.0 * static_cast<double>(axis + 1));
    }
    file.insert(file.end(), variable_records.begin(), variable_records.end());
    for (Bytes record : records) {
      record.resize(record_length);
      file.insert(file.end(), record.begin(), record.end());
    }
    return file;
  }
};

Bytes point(std::int32_t x, std::int32_t y, std::int32_t z) {
  Bytes record(12);
  put(record, 0, x);
  put(record, 4, y);
  put(record, 8, z);
  return record;
}

PointCloud read_all(LasReader reader) {
  PointCloud points;
  reader.read(points, std::numeric_limits<std::size_t>::max());
  return points;
}

PointCloud full_cloud(std::size_t n = 1000) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-100, 100);
  PointCloud cloud;
  cloud.origin = {691000, 5336000, 500};
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p(within(random), within(random), within(random));
    cloud.xyz.push_back((p * 1000).array().round().matrix().cast<float>() / 1000);
    cloud.normal.push_back(p.normalized().cast<float>());
    cloud.classification.push_back(static_cast<std::uint8_t>(i % 256));
    cloud.sigma_m.push_back(static_cast<float>(i % 50) * 0.01f);
    cloud.source.push_back(static_cast<std::uint16_t>(i % 3));
    cloud.feature.push_back(i % 2 ? static_cast<std::uint32_t>(4000000000u + i) : PointCloud::no_feature);
    cloud.intensity.push_back(static_cast<float>(i % 100) / 100);
    cloud.time_s.push_back(static_cast<float>(i) * 1e-4f - 0.05f);
  }
  return cloud;
}

TEST(LasReader, reads_positions_class_and_intensity_as_the_specification_lays_them_out) {
  Bytes record = point(-150, 200, 12345);
  put(record, 12, std::uint16_t{321});
  put(record, 15, std::uint8_t{0x20 | 6});  // class 6, synthetic flag
  const PointCloud points = read_all(LasReader(HandMade().bytes({record, point(0, 0, 0)}), "made"));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_LT((points.position(0) - Eigen::Vector3d(998.5, 2002.0, 3123.45)).norm(), 1e-5);
  EXPECT_EQ(points.classification[0], 6);
  EXPECT_EQ(points.intensity[0], 321);
}

TEST(LasReader, extended_formats_keep_all_eight_bits_of_the_class) {
  HandMade las{.minor = 4, .format = 6, .header_size = 375, .record_length = 30, .variable_records = {}};
  Bytes record = point(1, 2, 3);
  put(record, 16, std::uint8_t{200});
  const PointCloud points = read_all(LasReader(las.bytes({record}), "made"));
  EXPECT_EQ(points.classification.at(0), 200);
}

TEST(LasReader, reads_in_blocks) {
  LasReader reader(HandMade().bytes({point(0, 0, 0), point(100, 0, 0), point(200, 0, 0)}), "made");
  PointCloud points;
  ASSERT_TRUE(reader.read(points, 2));
  EXPECT_EQ(points.size(), 2u);
  ASSERT_TRUE(reader.read(points, 2, Eigen::Vector3d(1000, 0, 0)));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_FLOAT_EQ(points.xyz[0].x(), 2);
  EXPECT_FALSE(reader.read(points, 2));
  EXPECT_TRUE(points.empty());
}

Bytes geo_keys(std::initializer_list<std::array<std::uint16_t, 4>> entries) {
  Bytes content;
  for (const auto& entry : entries)
    for (std::uint16_t v : entry) put(content, content.size(), v);
  return content;
}

Bytes text_bytes(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.c_str());
  return Bytes(begin, begin + text.size() + 1);
}

TEST(LasReader, takes_the_crs_from_geotiff_keys) {
  HandMade las;
  las.add_record("LASF_Projection", 34735, geo_keys({{1, 1, 0, 3}, {1024, 0, 1, 1}, {3072, 0, 1, 25832}, {4096, 0, 1, 7837}}));
  EXPECT_EQ(LasReader(las.bytes({}), "made").header().crs, "EPSG:25832+7837");
}

TEST(LasReader, takes_the_wkt_where_the_geotiff_keys_are_user_defined) {
  HandMade las;
  las.add_record("LASF_Projection", 34735, geo_keys({{1, 1, 0, 2}, {3072, 0, 1, 32767}, {2048, 0, 1, 4326}}));
  las.add_record("LASF_Projection", 2112, text_bytes("PROJCS[\"x\"]"));
  EXPECT_EQ(LasReader(las.bytes({}), "made").header().crs, "PROJCS[\"x\"]");
}

TEST(LasReader, the_global_encoding_bit_decides_between_wkt_and_keys) {
  HandMade las;
  las.add_record("LASF_Projection", 34735, geo_keys({{1, 1, 0, 1}, {3072, 0, 1, 25832}}));
  las.add_record("LASF_Projection", 2112, text_bytes("WKT"));
  Bytes file = las.bytes({});
  EXPECT_EQ(LasReader(file, "made").header().crs, "EPSG:25832");
  put(file, 6, std::uint16_t{16});
  EXPECT_EQ(LasReader(file, "made").header().crs, "WKT");
}

TEST(LasReader, finds_the_wkt_in_an_extended_record_behind_the_points) {
  HandMade las{.minor = 4, .format = 6, .header_size = 375, .record_length = 30, .variable_records = {}};
  Bytes file = las.bytes({point(1, 2, 3)});
  const std::string wkt = "COMPD_CS[\"far behind\"]";
  const std::size_t at = file.size();
  put(file, 6, std::uint16_t{16});
  put(file, 235, static_cast<std::uint64_t>(at));
  put(file, 243, std::uint32_t{1});
  file.resize(at + 60);
  std::memcpy(&file[at + 2], "LASF_Projection", 15);
  put(file, at + 18, std::uint16_t{2112});
  put(file, at + 20, static_cast<std::uint64_t>(wkt.size()));
  const Bytes content = text_bytes(wkt);
  file.insert(file.end(), content.begin(), content.end() - 1);
  EXPECT_EQ(LasReader(file, "made").header().crs, wkt);
  file.resize(file.size() - 1);
  EXPECT_NE(message_of([&] { LasReader(file, "made"); }).find("outside the file"), std::string::npos);
}

TEST(LasReader, reads_extra_bytes_of_any_type_with_scale_offset_and_no_data) {
  HandMade las{.record_length = 28 + 1 + 4 + 2, .variable_records = {}};
  Bytes entries(3 * 192);
  put(entries, 2, std::uint8_t{0});       // opaque byte: skipped
  put(entries, 3, std::uint8_t{1});
  put(entries, 192 + 2, std::uint8_t{6});  // int32, scaled and shifted
  put(entries, 192 + 3, std::uint8_t{8 | 16});
  std::memcpy(&entries[192 + 4], "Sigma", 5);
  put(entries, 192 + 112, 0.5);
  put(entries, 192 + 136, 10.0);
  put(entries, 384 + 2, std::uint8_t{3});  // uint16 with no data
  put(entries, 384 + 3, std::uint8_t{1});
  std::memcpy(&entries[384 + 4], "Feature", 7);
  put(entries, 384 + 40, std::uint64_t{9});
  las.add_record("LASF_Spec", 4, entries);
  Bytes record = point(0, 0, 0);
  put(record, 29, std::int32_t{-4});
  put(record, 33, std::uint16_t{9});
  const PointCloud points = read_all(LasReader(las.bytes({record}), "made"));
  EXPECT_FLOAT_EQ(points.sigma_m.at(0), 8);
  EXPECT_EQ(points.feature.at(0), PointCloud::no_feature);
}

TEST(LasReader, refuses_what_is_cut_off_or_lies_about_itself) {
  const Bytes good = HandMade().bytes({point(0, 0, 0), point(1, 1, 1)});
  const auto refused = [&](const std::string& why, const std::function<void(Bytes&)>& spoil) {
    Bytes bad = good;
    spoil(bad);
    const std::string message = message_of([&] { LasReader(bad, "bad.las"); });
    EXPECT_NE(message.find(why), std::string::npos) << message;
    EXPECT_NE(message.find("bad.las"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  };
  refused("is no LAS file", [](Bytes& b) { b.clear(); });
  refused("is no LAS file", [](Bytes& b) { b[0] = std::byte{'X'}; });
  refused("LAS 1.5 is not supported", [](Bytes& b) { put(b, 25, std::uint8_t{5}); });
  refused("inside the LAS header", [](Bytes& b) { b.resize(150); });
  refused("too short for version", [](Bytes& b) { put(b, 94, std::uint16_t{100}); });
  refused("compressed (LAZ)", [](Bytes& b) { put(b, 104, std::uint8_t{128 + 1}); });
  refused("point format 4 is not supported", [](Bytes& b) { put(b, 104, std::uint8_t{4}); });
  refused("too short for point format", [](Bytes& b) { put(b, 105, std::uint16_t{20}); });
  refused("room for 2", [](Bytes& b) { put(b, 107, std::uint32_t{4000000000u}); });
  refused("room for 1; fetch or copy it again", [](Bytes& b) { b.pop_back(); });
  refused("outside the file", [](Bytes& b) { put(b, 96, std::uint32_t{3000000000u}); });
  refused("variable length records", [](Bytes& b) { put(b, 100, std::uint32_t{4000000000u}); });
  refused("scale or offset", [](Bytes& b) { put(b, 131, 0.0); });
  refused("scale or offset", [](Bytes& b) { put(b, 155, std::numeric_limits<double>::quiet_NaN()); });
}

TEST(LasReader, refuses_extra_bytes_that_do_not_fit_into_the_record) {
  HandMade las;
  Bytes entry(192);
  put(entry, 2, std::uint8_t{10});
  las.add_record("LASF_Spec", 4, entry);
  EXPECT_NE(message_of([&] { LasReader(las.bytes({}), "bad.las"); }).find("36 bytes"), std::string::npos);
}

TEST(LasReader, never_crashes_on_spoilt_bytes) {
  const Bytes good = encode_las(full_cloud(20), {.offset = {691000, 5336000, 0}, .wkt = "PROJCS[]"});
  std::mt19937 random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes bad = good;
    for (int k = 0; k < 3; ++k) bad[random() % 1500 % bad.size()] = static_cast<std::byte>(random());
    if (trial % 3 == 0) bad.resize(random() % bad.size());
    try {
      read_all(LasReader(bad, "bad.las"));
    } catch (const FormatError&) {
    }
  }
}

TEST(LasWriter, round_trip_at_utm_coordinates_is_exact_to_the_millimetre_lattice) {
  const PointCloud cloud = full_cloud();
  const LasWriteOptions options{.offset = {691000, 5336000, 0}, .wkt = "COMPD_CS[\"some\"]"};
  const Bytes bytes = encode_las(cloud, options);
  LasReader reader(bytes, "written");
  EXPECT_EQ(reader.header().crs, options.wkt);
  PointCloud back;
  ASSERT_TRUE(reader.read(back, cloud.size(), cloud.origin));
  ASSERT_EQ(back.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d written = (cloud.position(i) * 1000).array().round() / 1000;
    ASSERT_LT((back.position(i) - written).cwiseAbs().maxCoeff(), 1e-5);
    ASSERT_LT((back.normal[i] - cloud.normal[i]).cwiseAbs().maxCoeff(), 0.51f / 32767);
    ASSERT_NEAR(back.sigma_m[i], cloud.sigma_m[i], 1e-6);
  }
  EXPECT_EQ(back.classification, cloud.classification);
  EXPECT_EQ(back.source, cloud.source);
  EXPECT_EQ(back.feature, cloud.feature);
  EXPECT_EQ(back.intensity, cloud.intensity);
  EXPECT_EQ(back.time_s, cloud.time_s);
  EXPECT_EQ(encode_las(back, options), bytes) << "what was read writes the same bytes again";
}

TEST(LasWriter, states_count_and_extent_in_the_header) {
  const PointCloud cloud = full_cloud(10);
  const Bytes bytes = encode_las(cloud, {.offset = {691000, 5336000, 0}});
  Eigen::Vector3d min = cloud.position(0), max = min;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    min = min.cwiseMin(cloud.position(i));
    max = max.cwiseMax(cloud.position(i));
  }
  const LasHeader header = LasReader(bytes, "written").header();
  EXPECT_EQ(header.num_points, 10u);
  EXPECT_LT((header.min - min).norm(), 1e-3);
  EXPECT_LT((header.max - max).norm(), 1e-3);
  EXPECT_EQ(get<std::uint64_t>(bytes, 255), 10u) << "points of return 1";
}

TEST(LasWriter, every_supported_format_reads_back) {
  PointCloud cloud = full_cloud(50);
  for (auto& c : cloud.classification) c %= 32;
  for (int format : {0, 1, 2, 3, 6, 7, 8}) {
    LasReader reader(encode_las(cloud, {.point_format = format, .offset = {691000, 5336000, 0}}), "written");
    EXPECT_EQ(reader.header().point_format, format);
    PointCloud back;
    ASSERT_TRUE(reader.read(back, 100, cloud.origin));
    EXPECT_EQ(back.classification, cloud.classification);
    EXPECT_EQ(back.feature, cloud.feature);
    EXPECT_LT((back.position(49) - cloud.position(49)).norm(), 1e-3);
  }
}

TEST(LasWriter, unknown_sigma_stays_unknown_and_large_ones_do_not_become_unknown) {
  PointCloud cloud;
  cloud.xyz.assign(2, Eigen::Vector3f::Zero());
  cloud.sigma_m = {std::numeric_limits<float>::quiet_NaN(), 1000};
  const PointCloud back = read_all(LasReader(encode_las(cloud, {}), "written"));
  EXPECT_TRUE(std::isnan(back.sigma_m[0]));
  EXPECT_NEAR(back.sigma_m[1], 65.534, 1e-3);
}

TEST(LasWriter, whole_intensities_need_no_extra_bytes) {
  PointCloud cloud;
  cloud.xyz.assign(2, Eigen::Vector3f::Zero());
  cloud.intensity = {0, 65535};
  LasReader reader(encode_las(cloud, {}), "written");
  EXPECT_TRUE(reader.header().extra_byte_names.empty());
  EXPECT_EQ(read_all(std::move(reader)).intensity, cloud.intensity);
}

TEST(LasWriter, writes_an_empty_cloud) {
  LasReader reader(encode_las(PointCloud{}, {}), "written");
  EXPECT_EQ(reader.header().num_points, 0u);
  EXPECT_TRUE(reader.header().min.isZero());
  PointCloud points;
  EXPECT_FALSE(reader.read(points, 10));
}

TEST(LasWriter, refuses_what_the_format_cannot_hold) {
  PointCloud cloud;
  cloud.origin = {691000, 5336000, 0};
  cloud.xyz.assign(1, Eigen::Vector3f::Zero());
  EXPECT_THROW(encode_las(cloud, {}), UsageError) << "5336 km from the offset in millimetres";
  cloud.origin.setZero();
  EXPECT_THROW(encode_las(cloud, {.point_format = 5}), UsageError);
  EXPECT_THROW(encode_las(cloud, {.point_format = 1, .wkt = "x"}), UsageError);
  cloud.classification = {40};
  EXPECT_THROW(encode_las(cloud, {.point_format = 1}), UsageError);
  cloud.xyz[0].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(encode_las(cloud, {}), UsageError);
}

TEST(LasWriter, notices_a_full_disk) {
  EXPECT_THROW(write_las("/dev/full", full_cloud(10), {.offset = {691000, 5336000, 0}}), IoError);
}

TEST(LasWriter, takes_the_creation_date_from_source_date_epoch) {
  ::unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_EQ(get<std::uint32_t>(encode_las(PointCloud{}, {}), 90), 0u);
  ::setenv("SOURCE_DATE_EPOCH", "1709596800", 1);  // 2024-03-05, day 65 of a leap year
  const Bytes bytes = encode_las(PointCloud{}, {});
  ::unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_EQ(get<std::uint16_t>(bytes, 90), 65);
  EXPECT_EQ(get<std::uint16_t>(bytes, 92), 2024);
}

TEST(LasRealData, autzen_has_its_stated_count_and_extent) {
  const auto file = shared_data("als/autzen_trim.las");
  if (file.empty()) GTEST_SKIP() << "the real inputs are absent";
  LasReader reader(file);
  EXPECT_EQ(reader.header().num_points, 110000u);
  EXPECT_EQ(reader.header().point_format, 3);
  EXPECT_NE(reader.header().crs.find("NAD_1983_HARN_Lambert_Conformal_Conic"), std::string::npos);
  PointCloud block;
  Eigen::Vector3d min = reader.header().max, max = reader.header().min;
  while (reader.read(block, 4096)) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      min = min.cwiseMin(block.position(i));
      max = max.cwiseMax(block.position(i));
    }
  }
  EXPECT_LT((min - reader.header().min).cwiseAbs().maxCoeff(), 0.006);
  EXPECT_LT((max - reader.header().max).cwiseAbs().maxCoeff(), 0.006);
}

TEST(LasRealData, gothenburg_has_its_ground_points) {
  const auto file = shared_data("overlap_gothenburg/gvc.las");
  if (file.empty()) GTEST_SKIP() << "the real inputs are absent";
  LasReader reader(file);
  EXPECT_TRUE(reader.header().crs.empty());
  PointCloud points;
  ASSERT_TRUE(reader.read(points, 1000000));
  EXPECT_EQ(points.size(), 329643u);
  EXPECT_EQ(std::count(points.classification.begin(), points.classification.end(), 2), 194808);
}

TEST(LasRealData, laz_is_refused_by_name) {
  const auto file = shared_data("als/test_data_77050_627755_LA93_IGN69.laz");
  if (file.empty()) GTEST_SKIP() << "the real inputs are absent";
  EXPECT_NE(message_of([&] { LasReader reader(file); }).find("compressed (LAZ)"), std::string::npos);
}

}  // namespace
}  // namespace priormap
