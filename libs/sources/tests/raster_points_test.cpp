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

  /// All points, read in squares; sorted by position.
  std::vector<Point> read(const fs::path& file, const Crs& source, const Crs& target, const std::optional<double>& spacing = std::nullopt, double square = 1e4,
                          const std::optional<double>& least_wall_m = std::nullopt) {
    RasterPoints raster(file, source, target, spacing, least_wall_m);
    const Bounds2 bounds = raster.bounds().value();
    std::vector<Point> points;
    for (double y = std::floor(bounds.min_y); y <= bounds.max_y; y += square)
      for (double x = std::floor(bounds.min_x); x <= bounds.max_x; x += square) {
        const std::vector<Point> part = read_area(raster, {x, y, x + square, y + square});
        points.insert(points.end(), part.begin(), part.end());
      }
    const auto key = [](const Point& a) { return std::make_tuple(std::round(a.p.x() * 1000), std::round(a.p.y() * 1000), a.p.z()); };
    std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) { return key(a) < key(b); });
    return points;
  }

  static std::vector<Point> read_area(RasterPoints& raster, const Bounds2& area) {
    std::vector<Point> points;
    raster.read(area, {}, [&](const std::vector<LasPoint>& part) {
      for (const LasPoint& p : part) {
        points.push_back({Eigen::Vector3d(area.min_x + p.x / 1000.0, area.min_y + p.y / 1000.0, p.z / 1000.0), Eigen::Vector3f(p.normal[0], p.normal[1], p.normal[2]) / 32767});
        EXPECT_TRUE(area.contains(points.back().p.x() + 1e-4, points.back().p.y() + 1e-4));
      }
    });
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

TEST_F(RasterPointsTest, halves_of_a_thousandth_go_upwards) {
  const auto points = read(write({.value = [](double col, double) { return (2 * col - 9) * 0.0625; }}), utm, utm);
  ASSERT_EQ(points.size(), 80u);
  for (const Point& point : points) EXPECT_NEAR(point.p.z(), (2 * std::floor(point.p.x() - 500000) - 9) * 0.0625 + 0.0005, 1e-6) << point.p.transpose();
}

TEST_F(RasterPointsTest, the_normal_of_a_plane_is_the_planes_also_at_the_edge_and_beside_holes) {
  const auto points = read(write({.value = [](double col, double row) { return col == 4 && row == 4 ? std::nan("") : 0.5 * col - 0.25 * row; }}), utm, utm);
  const Eigen::Vector3f expected = Eigen::Vector3f(-0.5f, -0.25f, 1).normalized();  // rows go south
  ASSERT_EQ(points.size(), 79u);
  for (const Point& point : points) EXPECT_LT((point.normal - expected).norm(), 3e-5);
}

TEST_F(RasterPointsTest, flat_roofs_are_flat_up_to_their_edge) {
  const auto points = read(write({.value = [](double col, double) { return col >= 5 ? 10 : 0; }}), utm, utm);
  for (const Point& point : points) EXPECT_LT((point.normal - Eigen::Vector3f::UnitZ()).norm(), 1e-6) << point.p.transpose();
}

std::vector<Point> walls_of(std::vector<Point> points) {
  std::erase_if(points, [](const Point& point) { return point.normal.z() != 0 || point.normal.isZero(); });
  return points;
}

double house(double col, double row) { return col >= 2 && col < 6 && row >= 3 && row < 6 ? 12 : 2; }   // 4 m by 3 m, 10 m high

TEST_F(RasterPointsTest, a_house_gets_walls_halfway_between_the_cells_that_face_outwards) {
  const auto walls = walls_of(read(write({.value = house}), utm, utm, std::nullopt, 1e4, 1.5));
  ASSERT_EQ(walls.size(), 14u * 10u);
  const Eigen::Vector3d middle(500004, 4999995.5, 7);
  for (const Point& wall : walls) {
    const Eigen::Vector3d outward = wall.p - middle;
    EXPECT_NEAR(std::max(std::abs(outward.x()) / 2, std::abs(outward.y()) / 1.5), 1, 1e-6) << wall.p.transpose();
    EXPECT_GT(wall.normal.cast<double>().dot(outward), 1.4);
    EXPECT_NEAR(wall.normal.norm(), 1, 3e-5);
    EXPECT_NEAR(std::abs(std::remainder(wall.p.z(), 1)), 0.5, 1e-6);
    EXPECT_LT(std::abs(outward.z()), 5);
  }
}

// Across the grid a wall is a stair of cells, and yet it faces one way.
TEST_F(RasterPointsTest, a_wall_across_the_grid_faces_across_itself) {
  for (const double angle : {0.0, 0.15, 0.4, 0.785, 1.2}) {
    const Eigen::Vector3f facing(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0);
    const auto walls = walls_of(read(write({.value = [&](double col, double row) { return std::cos(angle) * (col - 5.2) - std::sin(angle) * (row - 4.4) < 0 ? 9.0 : 1.0; }}), utm, utm, std::nullopt, 1e4, 1.5));
    ASSERT_GT(walls.size(), 40u);
    std::size_t count = 0;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Point& wall : walls) {
      const Eigen::Vector3d p = wall.p - Eigen::Vector3d(500000, 5000000, 0);
      if (p.x() < 3 || p.x() > 7 || p.y() > -3 || p.y() < -5) continue;   // within two cells of the raster's edge it sees half
      EXPECT_GT(wall.normal.dot(facing), 0.9f) << angle << ": " << wall.normal.transpose();
      sum += wall.normal;
      ++count;
    }
    ASSERT_GT(count, 0u);
    EXPECT_GT(sum.normalized().dot(facing), 0.96f) << angle;
  }
}

TEST_F(RasterPointsTest, low_steps_and_coarse_cells_have_no_walls) {
  EXPECT_TRUE(walls_of(read(write({.value = house}), utm, utm)).empty());
  EXPECT_TRUE(walls_of(read(write({.value = house}), utm, utm, std::nullopt, 1e4, 10.5)).empty());
  EXPECT_TRUE(walls_of(read(write({.transform = {500000, 5, 0, 5000000, 0, -5}, .value = house}), utm, utm, std::nullopt, 1e4, 1.5)).empty());
}

TEST_F(RasterPointsTest, no_wall_is_higher_than_a_kilometre) {
  const auto step = [](double height) { return [height](double col, double) { return col < 5 ? 0 : height; }; };
  EXPECT_EQ(walls_of(read(write({.value = step(900)}), utm, utm, std::nullopt, 1e4, 1.5)).size(), 8u * 900u);
  EXPECT_TRUE(walls_of(read(write({.value = step(1100)}), utm, utm, std::nullopt, 1e4, 1.5)).empty());
}

// Nodes of a lattice between two cells see half of a step each: as walls they would be two, of which low ones are none.
TEST_F(RasterPointsTest, a_lattice_has_the_walls_of_the_rasters_cells) {
  const fs::path shed = write({.transform = {500000.3, 1, 0, 5000000.7, 0, -1}, .crs = "EPSG:25832", .value = [](double col, double row) { return house(col, row) > 2 ? 2.5 : 0; }});
  for (const char* target : {"EPSG:25832", "EPSG:25833"}) {
    const auto walls = [&](const std::optional<double>& spacing) { return walls_of(read(shed, Crs::parse("EPSG:25832"), Crs::parse(target), spacing, 1e4, 1.5)); };
    const auto of_cells = walls(std::nullopt);
    ASSERT_EQ(of_cells.size(), 14u * 3u);
    for (const double spacing : {0.3, 1.0, 4.0}) {
      const auto of_lattice = walls(spacing);
      ASSERT_EQ(of_lattice.size(), of_cells.size()) << spacing;
      for (std::size_t i = 0; i < of_cells.size(); ++i) {
        EXPECT_EQ(of_lattice[i].p, of_cells[i].p);
        EXPECT_EQ(of_lattice[i].normal, of_cells[i].normal);
      }
    }
  }
  const auto tower = [](double col, double row) { return col >= 3 && col < 6 && row >= 3 && row < 6 ? 60 : 0; };
  EXPECT_TRUE(walls_of(read(write({.transform = {500000, 5, 0, 5000000, 0, -5}, .value = tower}), utm, utm, 0.5, 1e4, 1.5)).empty()) << "cells too coarse to tell where a wall stands";
}

TEST_F(RasterPointsTest, walls_do_not_depend_on_the_areas_in_which_they_are_read) {
  const auto town = [](double col, double row) { return 5 * (std::fmod((col + 0.3 * row) * 0.131, 1) > 0.5) + 4 * (std::fmod((row + 0.4 * col) * 0.077, 1) > 0.4) + 0.01 * col; };
  const fs::path file = write({.width = 300, .height = 250, .crs = "EPSG:25832", .value = town});
  for (const char* target : {"EPSG:25832", "EPSG:25833"})
    for (const std::optional<double>& spacing : {std::optional<double>(), std::optional(1.1)}) {
      const auto whole = walls_of(read(file, Crs::parse("EPSG:25832"), Crs::parse(target), spacing, 1e4, 1.5));
      const auto parts = walls_of(read(file, Crs::parse("EPSG:25832"), Crs::parse(target), spacing, 77, 1.5));
      EXPECT_GT(whole.size(), 10000u);
      ASSERT_EQ(parts.size(), whole.size()) << target;
      for (std::size_t i = 0; i < whole.size(); ++i) {
        ASSERT_LT((parts[i].p - whole[i].p).norm(), 4e-4);
        ASSERT_EQ(parts[i].normal, whole[i].normal) << parts[i].p.transpose();
      }
    }
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

TEST_F(RasterPointsTest, points_do_not_depend_on_the_areas_in_which_they_are_read) {
  const auto wave = [](double col, double row) { return 20 * std::sin(col * 0.03) + 10 * std::cos(row * 0.05); };
  const fs::path file = write({.width = 300, .height = 250, .crs = "EPSG:25832", .value = wave});
  for (const char* target : {"EPSG:25832", "EPSG:25833"}) {
    for (const std::optional<double>& spacing : {std::optional<double>(), std::optional(0.9)}) {
      const auto whole = read(file, Crs::parse("EPSG:25832"), Crs::parse(target), spacing), parts = read(file, Crs::parse("EPSG:25832"), Crs::parse(target), spacing, 77);
      if (!spacing) { ASSERT_EQ(whole.size(), 75000u); }
      ASSERT_EQ(parts.size(), whole.size());
      for (std::size_t i = 0; i < whole.size(); ++i) {
        ASSERT_LT((parts[i].p - whole[i].p).norm(), 4e-4);
        ASSERT_EQ(parts[i].normal, whole[i].normal);
      }
    }
  }
}

TEST_F(RasterPointsTest, areas_come_in_the_order_of_tiles_walls_included) {
  const auto town = [](double col, double row) { return 5 * (std::fmod(col * 0.131, 1) > 0.5) + 4 * (std::fmod(row * 0.077, 1) > 0.4) + 0.01 * col; };
  RasterPoints raster(write({.width = 600, .height = 500, .value = town}), utm, utm, std::nullopt, 1.5);
  std::vector<std::tuple<int, int, int>> places;
  raster.read({500100, 4999600, 500300, 4999800}, {}, [&](const std::vector<LasPoint>& points) {
    for (const LasPoint& p : points) places.emplace_back(p.x, p.y, p.z);
  });
  EXPECT_GT(places.size(), 41000u);
  for (std::size_t i = 1; i < places.size(); ++i) ASSERT_LT(places[i - 1], places[i]);
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
  const auto points = read(file, utm, utm, 0.5);
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

TEST_F(RasterPointsTest, no_cell_is_lost_at_the_antimeridian_however_longitudes_are_counted) {
  const Crs lon_lat = Crs::parse("EPSG:4326"), zone_60 = Crs::parse("EPSG:32760");
  const double cell = 1e-5;
  for (const double west : {179.9998, 180 - 40 * cell, -180.0002, -180.0, 177.0}) {
    const fs::path file = write({.width = 40, .height = 40, .transform = {west, cell, 0, -17, 0, -cell}, .crs = "EPSG:4326"});
    EXPECT_EQ(read(file, lon_lat, zone_60).size(), 1600u) << west;
    const HeightRaster raster = HeightRaster::open(file, std::nullopt, zone_60);
    const Eigen::Vector3d middle = Transformer(lon_lat, zone_60).forward({west + 20.5 * cell, -17 - 20.5 * cell, 0});
    EXPECT_NEAR(raster.at(middle.x(), middle.y()).value_or(-1), 20 + 100 * 20, 1e-2) << west;
  }
}

}  // namespace
}  // namespace priormap
