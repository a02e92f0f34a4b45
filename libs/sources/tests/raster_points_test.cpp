#include <priormap/sources/raster_points.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include <priormap/core/error.hpp>

#include "raster_fixture.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;
const Crs utm = Crs::parse("EPSG:32632");

struct Point {
  Eigen::Vector3d p;
  Eigen::Vector3f normal;
};

class RasterPointsTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "priormap_raster_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const RasterFixture& fixture) {
    fixture.write(folder_ / "dem.tif");
    return folder_ / "dem.tif";
  }

  /// Sorted by position.
  std::vector<Point> read(const fs::path& file, const Crs& source, const Crs& target, const RasterPointsOptions& options = {}) {
    RasterPoints raster(file, source, target, options);
    std::vector<Point> points;
    for (std::size_t block = 0; block < raster.num_blocks(); ++block) {
      raster.read_block(block, [&](PointCloud& cloud) {
        cloud.check_columns();
        for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back({cloud.position(i), cloud.normal.at(i)});
      });
    }
    const auto key = [](const Point& a) { return std::make_tuple(a.p.x(), a.p.y(), a.p.z()); };
    std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) { return key(a) < key(b); });
    return points;
  }

  fs::path folder_;
};

TEST_F(RasterPointsTest, each_cell_with_data_is_one_point_at_its_centre) {
  const auto points = read(write({.no_data = -1, .value = [](double col, double row) { return col == 2 && row == 3 ? -1 : col + 100 * row; }}), utm, utm);
  ASSERT_EQ(points.size(), 79u);
  EXPECT_LT((points[0].p - Eigen::Vector3d(500000.5, 4999992.5, 700)).norm(), 1e-9);
  EXPECT_LT((points.back().p - Eigen::Vector3d(500009.5, 4999999.5, 9)).norm(), 1e-9);
}

TEST_F(RasterPointsTest, the_normal_of_a_plane_is_the_planes_also_at_the_edge_and_beside_holes) {
  const auto points = read(write({.value = [](double col, double row) { return col == 4 && row == 4 ? std::nan("") : 0.5 * col - 0.25 * row; }}), utm, utm);
  const Eigen::Vector3f expected = Eigen::Vector3f(-0.5f, -0.25f, 1).normalized();  // rows go south
  ASSERT_EQ(points.size(), 79u);
  for (const Point& point : points) EXPECT_LT((point.normal - expected).norm(), 1e-6);
}

TEST_F(RasterPointsTest, flat_roofs_are_flat_up_to_their_edge) {
  const auto points = read(write({.value = [](double col, double) { return col >= 5 ? 10 : 0; }}), utm, utm);
  for (const Point& point : points) EXPECT_LT((point.normal - Eigen::Vector3f::UnitZ()).norm(), 1e-6) << point.p.transpose();
}

TEST_F(RasterPointsTest, a_single_cell_has_no_normal) {
  const auto points = read(write({.value = [](double col, double row) { return col == 4 && row == 4 ? 1 : std::nan(""); }}), utm, utm);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_TRUE(points[0].normal.isZero());
}

TEST_F(RasterPointsTest, results_do_not_depend_on_how_the_file_is_blocked) {
  const auto wave = [](double col, double row) { return 20 * std::sin(col * 0.03) + 10 * std::cos(row * 0.05); };
  RasterFixture fixture{.width = 1100, .height = 700, .value = wave};
  const auto strips = read(write(fixture), utm, utm);
  fixture.creation_options = {"TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256"};
  const auto tiles = read(write(fixture), utm, utm);
  ASSERT_EQ(strips.size(), 770000u);
  ASSERT_EQ(tiles.size(), strips.size());
  for (std::size_t i = 0; i < strips.size(); ++i) {
    ASSERT_LT((strips[i].p - tiles[i].p).norm(), 1e-4);
    ASSERT_EQ(strips[i].normal, tiles[i].normal);
  }
}

TEST_F(RasterPointsTest, within_leaves_out_blocks_but_changes_no_point) {
  RasterFixture fixture{.width = 2000, .height = 2000, .creation_options = {"TILED=YES"}, .value = [](double col, double row) { return 0.01 * col * row; }};
  const fs::path file = write(fixture);
  const Bounds2 box{500900, 4999000, 501000, 4999100};
  const auto inside = [&](std::vector<Point> points) {
    std::erase_if(points, [&](const Point& point) { return !box.contains(point.p.x(), point.p.y()); });
    return points;
  };
  const auto all = read(file, utm, utm);
  const auto part = read(file, utm, utm, {.spacing = std::nullopt, .within = box});
  EXPECT_LT(part.size(), all.size() / 2);
  const auto expected = inside(all), got = inside(part);
  ASSERT_EQ(got.size(), 10000u);
  ASSERT_EQ(expected.size(), got.size());
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_EQ(got[i].normal, expected[i].normal);
}

TEST_F(RasterPointsTest, in_another_crs_every_cell_is_where_proj_puts_it) {
  // One arc second of latitude is 30.9 m; heights rise by 1 m for 0.001 degrees to the east (74 m).
  const auto points = read(write({.width = 40, .height = 30, .transform = {11.5, 0.001, 0, 48.2, 0, -0.001}, .crs = "EPSG:4326", .value = [](double col, double) { return col; }}),
                           Crs::parse("EPSG:4326"), utm);
  ASSERT_EQ(points.size(), 1200u);
  const Transformer back(utm, Crs::parse("EPSG:4326"));
  for (const Point& point : points) {
    const Eigen::Vector3d p = back.forward(point.p);
    const double col = (p.x() - 11.5) / 0.001 - 0.5, row = (48.2 - p.y()) / 0.001 - 0.5;
    EXPECT_NEAR(col, std::round(col), 2e-5);
    EXPECT_NEAR(row, std::round(row), 2e-5);
    EXPECT_NEAR(point.p.z(), col, 1.1e-3);
    EXPECT_NEAR(point.normal.x() / point.normal.z(), -1 / 74.3, 2e-4);
  }
}

TEST_F(RasterPointsTest, a_lattice_has_its_nodes_in_the_middle_of_global_cells) {
  const fs::path file = write({.width = 20, .height = 20, .transform = {500000.3, 2, 0, 5000000.7, 0, -2}, .value = [](double col, double row) { return 0.5 * (2 * col + 1) - (2 * row + 1); }});
  const auto points = read(file, utm, utm, {.spacing = 0.5, .within = std::nullopt});
  EXPECT_EQ(points.size(), 6400u);
  for (const Point& point : points) {
    EXPECT_NEAR(std::fmod(point.p.x(), 0.5), 0.25, 1e-9);
    EXPECT_NEAR(std::fmod(point.p.y(), 0.5), 0.25, 1e-9);
    const bool between_centres = point.p.x() > 500001.3 && point.p.x() < 500039.3 && point.p.y() < 4999999.7 && point.p.y() > 4999961.7;
    if (!between_centres) continue;
    EXPECT_NEAR(point.p.z(), 0.5 * (point.p.x() - 500000.3) + (point.p.y() - 5000000.7), 1e-3);
  }
}

TEST_F(RasterPointsTest, coarse_cells_keep_the_millimetre) {
  const auto points = read(write({.width = 300, .height = 300, .transform = {500000.123, 90, 0, 5000000.456, 0, -90}, .value = [](double col, double row) { return 0.001 * col + row; }}), utm, utm);
  ASSERT_EQ(points.size(), 90000u);
  for (const Point& point : points) {
    const double col = std::round((point.p.x() - 500000.123) / 90 - 0.5);
    EXPECT_NEAR(point.p.x(), 500000.123 + 90 * (col + 0.5), 2e-4);
  }
}

}  // namespace
}  // namespace priormap
