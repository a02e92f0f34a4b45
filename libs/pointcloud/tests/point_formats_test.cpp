#include <priormap/pointcloud/point_formats.hpp>

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include <priormap/core/error.hpp>
#include <priormap/core/output_file.hpp>
#include <priormap/pointcloud/kitti_bin.hpp>

#include "test_support.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

PointCloud full_cloud() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> within(-100, 100);
  PointCloud cloud;
  cloud.origin = {691000.125, 5336000.5, 500};
  for (std::size_t i = 0; i < 300; ++i) {
    cloud.xyz.push_back({within(random), within(random), within(random)});
    cloud.normal.push_back(cloud.xyz.back().normalized());
    cloud.classification.push_back(static_cast<std::uint8_t>(i % 256));
    cloud.sigma_m.push_back(i % 5 ? 0.1f * static_cast<float>(i) : std::nanf(""));
    cloud.source.push_back(static_cast<std::uint16_t>(60000 + i % 3));
    cloud.feature.push_back(i % 2 ? static_cast<std::uint32_t>(4000000000u + i) : PointCloud::no_feature);
    cloud.intensity.push_back(static_cast<float>(i) / 300);
    cloud.time_s.push_back(static_cast<float>(i) * 1e-4f - 0.05f);
  }
  return cloud;
}

void expect_same_columns(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.classification, b.classification);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.feature, b.feature);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.time_s, b.time_s);
  ASSERT_EQ(a.sigma_m.size(), b.sigma_m.size());
  for (std::size_t i = 0; i < a.sigma_m.size(); ++i) EXPECT_TRUE(a.sigma_m[i] == b.sigma_m[i] || (std::isnan(a.sigma_m[i]) && std::isnan(b.sigma_m[i])));
}

struct Case {
  const char* file;
  PcdEncoding encoding;
};

class ExactRoundTrip : public testing::TestWithParam<Case> {};

TEST_P(ExactRoundTrip, of_positions_at_utm_coordinates_and_all_columns) {
  const TemporaryFolder folder;
  const PointCloud cloud = full_cloud();
  const fs::path file = folder / GetParam().file;
  write_point_cloud(file, cloud, {.crs = "EPSG:25832+7837", .encoding = GetParam().encoding});
  const CloudFile back = read_point_cloud(file);
  EXPECT_EQ(back.crs, "EPSG:25832+7837");
  EXPECT_EQ(back.points.origin, cloud.origin);
  EXPECT_EQ(back.points.xyz, cloud.xyz);
  expect_same_columns(back.points, cloud);
  write_point_cloud(file, back.points, {.crs = back.crs, .encoding = GetParam().encoding, .overwrite = Overwrite::allow});
  EXPECT_EQ(read_point_cloud(file).points.xyz, cloud.xyz);
}

INSTANTIATE_TEST_SUITE_P(Formats, ExactRoundTrip,
                         testing::Values(Case{"a.pcd", PcdEncoding::ascii}, Case{"b.pcd", PcdEncoding::binary},
                                         Case{"c.PCD", PcdEncoding::binary_compressed}, Case{"d.ply", PcdEncoding::ascii},
                                         Case{"e.ply", PcdEncoding::binary}, Case{"f.xyz", PcdEncoding::ascii}));

TEST(PointFormats, las_round_trip_is_exact_to_its_resolution) {
  const TemporaryFolder folder;
  const PointCloud cloud = full_cloud();
  write_point_cloud(folder / "a.las", cloud, {.crs = "COMPD_CS[]"});
  const CloudFile back = read_point_cloud(folder / "a.las");
  EXPECT_EQ(back.crs, "COMPD_CS[]");
  ASSERT_EQ(back.points.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    ASSERT_LT((back.points.position(i) - cloud.position(i)).cwiseAbs().maxCoeff(), 0.00053);
  EXPECT_EQ(back.points.feature, cloud.feature);
  EXPECT_FALSE(fs::exists(georeference_path(folder / "a.las")));
}

TEST(PointFormats, pcl_reads_what_is_written) {
  const TemporaryFolder folder;
  const PointCloud cloud = full_cloud();
  write_point_cloud(folder / "a.pcd", cloud);
  write_point_cloud(folder / "b.ply", cloud, {.encoding = PcdEncoding::binary});
  pcl::PointCloud<pcl::PointXYZINormal> pcd, ply;
  ASSERT_EQ(pcl::io::loadPCDFile((folder / "a.pcd").string(), pcd), 0);
  ASSERT_EQ(pcl::io::loadPLYFile((folder / "b.ply").string(), ply), 0);
  for (const auto& read : {pcd, ply}) {
    ASSERT_EQ(read.size(), cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_EQ(read[i].getVector3fMap(), cloud.xyz[i]);
      ASSERT_EQ(read[i].getNormalVector3fMap(), cloud.normal[i]);
      ASSERT_EQ(read[i].intensity, cloud.intensity[i]);
    }
  }
}

TEST(PointFormats, reads_what_pcl_writes) {
  const TemporaryFolder folder;
  pcl::PointCloud<pcl::PointXYZI> cloud;
  for (int i = 0; i < 100; ++i) {
    pcl::PointXYZI p;
    p.x = static_cast<float>(i) * 0.1f, p.y = 2, p.z = -3, p.intensity = static_cast<float>(i);
    cloud.push_back(p);
  }
  pcl::io::savePCDFileASCII((folder / "a.pcd").string(), cloud);
  pcl::io::savePCDFileBinary((folder / "b.pcd").string(), cloud);
  pcl::io::savePCDFileBinaryCompressed((folder / "c.pcd").string(), cloud);
  pcl::io::savePLYFileASCII((folder / "d.ply").string(), cloud);
  pcl::io::savePLYFileBinary((folder / "e.ply").string(), cloud);
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd", "d.ply", "e.ply"}) {
    const PointCloud read = read_point_cloud(folder / name).points;
    ASSERT_EQ(read.size(), 100u) << name;
    EXPECT_NEAR(read.xyz[50].x(), 5, 1e-5) << name;
    EXPECT_EQ(read.intensity.at(50), 50) << name;
  }
}

TEST(PointFormats, double_coordinates_keep_their_digits) {
  const TemporaryFolder folder;
  write_text(folder / "a.pcd",
             "VERSION 0.7\nFIELDS x y z label t\nSIZE 8 8 8 2 4\nTYPE F F F U U\nCOUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
             "691000.123 5336000.456 500.789 7 100000000\n691010.5 5336000.25 501 8 0\n");
  write_text(folder / "b.ply",
             "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\nproperty uchar classification\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
             "691000.123 5336000.456 500.789 6\n691010.5 5336000.25 501 2\n3 0 1 0\n");
  for (const char* name : {"a.pcd", "b.ply"}) {
    const PointCloud read = read_point_cloud(folder / name).points;
    ASSERT_EQ(read.size(), 2u) << name;
    EXPECT_LT((read.position(0) - Eigen::Vector3d(691000.123, 5336000.456, 500.789)).norm(), 1e-6) << name;
    EXPECT_LT((read.position(1) - Eigen::Vector3d(691010.5, 5336000.25, 501)).norm(), 1e-6) << name;
  }
  EXPECT_FLOAT_EQ(read_point_cloud(folder / "a.pcd").points.time_s.at(0), 0.1f) << "integer times are nanoseconds";
  EXPECT_EQ(read_point_cloud(folder / "b.ply").points.classification, (std::vector<std::uint8_t>{6, 2}));
}

TEST(PointFormats, epoch_times_count_from_the_earliest_point) {
  const TemporaryFolder folder;
  write_text(folder / "a.xyz", "x,y,z,timestamp\n1,2,3,1700000000.25\n1,2,3,1700000000.125\n");
  EXPECT_EQ(read_point_cloud(folder / "a.xyz").points.time_s, (std::vector<float>{0.125f, 0}));
}

TEST(PointFormats, text_in_its_many_forms) {
  const TemporaryFolder folder;
  const auto first = [&](const std::string& text) {
    write_text(folder / "a.txt", text);
    const PointCloud read = read_point_cloud(folder / "a.txt").points;
    return read.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : read.position(0);
  };
  const Eigen::Vector3d expected(691000.5, 5336000.25, 3);
  EXPECT_EQ(first("691000.5 5336000.25 3\n"), expected);
  EXPECT_EQ(first("# made by hand\r\n691000.5, 5336000.25,\t+3 , 17\r\n\r\n"), expected);
  EXPECT_EQ(first("\"id\";\"Z\";\"Y\";\"X\"\n1;3;5336000.25;6.910005e5"), expected);
  EXPECT_EQ(first("// z y x\n3 5336000.25 691000.5\n"), expected);
  EXPECT_EQ(first(""), Eigen::Vector3d::Zero());
}

TEST(PointFormats, broken_text_is_refused_with_its_line) {
  const TemporaryFolder folder;
  write_text(folder / "a.xyz", "1 2 3\n4 5\n");
  EXPECT_NE(message_of([&] { read_point_cloud(folder / "a.xyz"); }).find("line 2"), std::string::npos);
  write_text(folder / "a.xyz", "1 2 3\n4 5 six\n");
  EXPECT_NE(message_of([&] { read_point_cloud(folder / "a.xyz"); }).find("'six' is no number"), std::string::npos);
  write_text(folder / "a.xyz", "hello\n");
  EXPECT_THROW(read_point_cloud(folder / "a.xyz"), FormatError);
}

TEST(PointFormats, what_a_header_promises_is_checked_before_memory_is_taken) {
  const TemporaryFolder folder;
  const std::string pcd = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 4000000000\nHEIGHT 1\nPOINTS 4000000000\n";
  for (const char* encoding : {"ascii", "binary", "binary_compressed"}) {
    write_text(folder / "a.pcd", pcd + "DATA " + encoding + "\n1 2 3\n");
    EXPECT_NE(message_of([&] { read_point_cloud(folder / "a.pcd"); }).find("promises 4000000000"), std::string::npos) << encoding;
  }
  for (const char* format : {"ascii", "binary_little_endian"}) {
    write_text(folder / "a.ply", "ply\nformat " + std::string(format) +
                                     " 1.0\nelement vertex 2000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n");
    EXPECT_NE(message_of([&] { read_point_cloud(folder / "a.ply"); }).find("promises 2000000000"), std::string::npos) << format;
  }
}

TEST(PointFormats, compressed_points_that_claim_another_size_are_refused) {
  const TemporaryFolder folder;
  const std::string head = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary_compressed\n";
  const auto words = [](std::uint32_t packed, std::uint32_t unpacked) {
    const std::array<std::uint32_t, 2> sizes = {packed, unpacked};
    return std::string(reinterpret_cast<const char*>(sizes.data()), sizeof sizes);
  };
  for (const std::string& sizes : {words(13, 4000000000u), words(4000000000u, 12), words(0, 12), std::string("abc")}) {
    write_text(folder / "a.pcd", head + sizes + std::string(13, '\0'));
    EXPECT_THROW(read_point_cloud(folder / "a.pcd"), FormatError);
  }
}

TEST(PointFormats, broken_files_are_format_errors) {
  const TemporaryFolder folder;
  for (const char* text : {"", "nonsense", "VERSION 0.7\nDATA ascii\n", "VERSION 0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2\n",
                           "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH x\nHEIGHT 1\nPOINTS y\nDATA binary\n"}) {
    write_text(folder / "a.pcd", text);
    EXPECT_THROW(read_point_cloud(folder / "a.pcd"), FormatError) << text;
    write_text(folder / "a.ply", text);
    EXPECT_THROW(read_point_cloud(folder / "a.ply"), FormatError) << text;
  }
  EXPECT_THROW(read_point_cloud(folder / "missing.pcd"), IoError);
  write_text(folder / "a.docx", "x");
  EXPECT_THROW(read_point_cloud(folder / "a.docx"), FormatError);
}

TEST(PointFormats, a_cut_binary_file_is_refused) {
  const TemporaryFolder folder;
  for (const char* name : {"a.pcd", "b.ply"}) {
    write_point_cloud(folder / name, full_cloud(), {.encoding = PcdEncoding::binary});
    fs::resize_file(folder / name, fs::file_size(folder / name) - 1);
    EXPECT_THROW(read_point_cloud(folder / name), FormatError) << name;
  }
}

TEST(PointFormats, the_georeference_beside_moves_the_cloud) {
  const TemporaryFolder folder;
  write_text(folder / "a.xyz", "1 2 3\n");
  write_text(folder / "a.xyz.georef.json", R"({"origin": [691000, 5336000, 500], "crs": null})");
  EXPECT_EQ(read_point_cloud(folder / "a.xyz").points.position(0), Eigen::Vector3d(691001, 5336002, 503));
  write_text(folder / "a.xyz.georef.json", R"({"origin": [691000]})");
  EXPECT_THROW(read_point_cloud(folder / "a.xyz"), FormatError);
}

TEST(PointFormats, a_replaced_cloud_leaves_no_georeference_of_the_old_one) {
  const TemporaryFolder folder;
  write_point_cloud(folder / "a.pcd", full_cloud());
  PointCloud local;
  local.xyz = {{1, 2, 3}};
  EXPECT_THROW(write_point_cloud(folder / "a.pcd", local), IoError);
  write_point_cloud(folder / "a.pcd", local, {.overwrite = Overwrite::allow});
  EXPECT_EQ(read_point_cloud(folder / "a.pcd").points.position(0), Eigen::Vector3d(1, 2, 3));
}

TEST(PointFormats, empty_clouds_are_written_and_read) {
  const TemporaryFolder folder;
  for (const char* name : {"a.pcd", "b.ply", "c.xyz", "d.las"}) {
    write_point_cloud(folder / name, PointCloud{});
    EXPECT_TRUE(read_point_cloud(folder / name).points.empty()) << name;
  }
}

TEST(PointFormats, kitti_scans_come_as_the_file_says) {
  const TemporaryFolder folder;
  std::vector<float> values;
  for (int i = 0; i < 4 * 10000; ++i) values.push_back(static_cast<float>(i));
  std::ofstream(folder / "000000.bin", std::ios::binary).write(reinterpret_cast<const char*>(values.data()), static_cast<long>(values.size() * 4));
  const PointCloud scan = read_kitti_bin(folder / "000000.bin");
  ASSERT_EQ(scan.size(), 10000u);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    ASSERT_EQ(scan.xyz[i], Eigen::Vector3f(values[4 * i], values[4 * i + 1], values[4 * i + 2]));
    ASSERT_EQ(scan.intensity[i], values[4 * i + 3]);
  }
  fs::resize_file(folder / "000000.bin", 100);
  EXPECT_NE(message_of([&] { read_kitti_bin(folder / "000000.bin"); }).find("multiple of 16"), std::string::npos);
  EXPECT_THROW(read_kitti_bin(folder / "none.bin"), IoError);
  EXPECT_THROW(read_kitti_bin(folder / "."), IoError);
}

TEST(PointFormats, unknown_extensions_cannot_be_written) {
  const TemporaryFolder folder;
  for (const char* name : {"a.laz", "a.bin", "a.obj", "a"}) EXPECT_THROW(write_point_cloud(folder / name, full_cloud()), UsageError) << name;
}

}  // namespace
}  // namespace priormap
