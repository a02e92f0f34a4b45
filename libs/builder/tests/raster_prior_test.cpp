#include <priormap/builder/raster_prior.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <tuple>

#include <priormap/core/error.hpp>
#include <priormap/prior/prior_store.hpp>

#include "../../sources/tests/raster_fixture.hpp"
#include "raster_faults.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

class RasterPriorTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "priormap_raster_prior_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const RasterFixture& fixture, const std::string& name) {
    fixture.write(folder_ / name);
    return folder_ / name;
  }

  fs::path build(const std::vector<fs::path>& inputs, const PriorOptions& options, const std::string& name, int threads = 2, const RasterPriorOptions& raster = {}) {
    Events events;
    events.warning = [&](const std::string& message) { warnings_.push_back(message); };
    report_ = build_raster_prior(inputs, options, raster, folder_ / name, Overwrite::refuse, "test", threads, events);
    return folder_ / name;
  }

  static PointCloud points_of(const fs::path& prior) {
    const PriorStore store(prior);
    PointCloud all;
    for (const TileEntry& tile : store.tiles()) {
      const PointCloud points = store.load(tile.key).points;
      if (all.empty()) all.origin = points.origin;
      all.append(points);
    }
    return all;
  }

  /// Path in the prior -> content.
  static std::map<std::string, std::string> bytes_of(const fs::path& prior) {
    std::map<std::string, std::string> bytes;
    for (const auto& entry : fs::recursive_directory_iterator(prior)) {
      if (!entry.is_regular_file()) continue;
      std::ostringstream content;
      content << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      bytes[entry.path().lexically_relative(prior).string()] = content.str();
    }
    return bytes;
  }

  static std::size_t count_sources(const PointCloud& points, std::uint16_t source) {
    return static_cast<std::size_t>(std::count(points.source.begin(), points.source.end(), source));
  }

  fs::path folder_;
  std::vector<std::string> warnings_;
  RasterReport report_;
};

PriorOptions with_crs(const std::string& crs) {
  PriorOptions options;
  options.crs = crs;
  return options;
}

RasterFixture hills(int width = 700, int height = 500) {
  return {.width = width, .height = height, .transform = {691000, 1, 0, 5336000, 0, -1}, .crs = "EPSG:32632",
          .value = [](double col, double row) { return 500 + 10 * std::sin(col * 0.02) + 5 * std::cos(row * 0.03); }};
}

TEST_F(RasterPriorTest, every_cell_is_a_point_with_class_source_and_sigma) {
  const fs::path prior = build({write(hills(), "dem.tif")}, {}, "prior", 2, {.kind = "terrain", .sigma_m = 0.25});
  const PointCloud points = points_of(prior);
  ASSERT_EQ(points.size(), 350000u);
  EXPECT_EQ(points.classification.front(), 2);
  EXPECT_FLOAT_EQ(points.sigma_m.front(), 0.25f);
  EXPECT_EQ(report_.manifest.crs, "EPSG:32632");
  EXPECT_FALSE(report_.manifest.vertical);
  EXPECT_EQ(warnings_.size(), 1u) << "heights are undeclared";
  ASSERT_EQ(report_.manifest.sources.size(), 1u);
  EXPECT_EQ(report_.manifest.sources[0].file_name, "dem.tif");
}

TEST_F(RasterPriorTest, a_surface_has_walls_and_bare_ground_has_none) {
  const fs::path file = write({.width = 20, .height = 20, .transform = {691000, 1, 0, 5336000, 0, -1},
                               .value = [](double col, double row) { return col >= 5 && col < 15 && row >= 5 && row < 15 ? 510 : 500; }}, "dem.tif");
  const auto walls = [&](const std::string& name, const RasterPriorOptions& raster) {
    const PointCloud points = points_of(build({file}, {}, name, 1, raster));
    return std::ranges::count_if(points.normal, [](const Eigen::Vector3f& n) { return std::abs(n.z()) < 0.1f; });
  };
  const auto facts = [&] { return std::map<std::string, std::string>(report_.manifest.sources[0].facts.begin(), report_.manifest.sources[0].facts.end()); };
  RasterPriorOptions surface, terrain, without;
  terrain.kind = "terrain";
  without.least_wall_m = 0;
  EXPECT_EQ(walls("surface", surface), 40 * 10);
  EXPECT_EQ(facts().at("wall_points"), "400");
  EXPECT_EQ(facts().at("least_wall_m"), "1.5");
  EXPECT_EQ(walls("terrain", terrain), 0);
  EXPECT_EQ(walls("without", without), 0);
  EXPECT_FALSE(facts().contains("wall_points"));
}

TEST_F(RasterPriorTest, sigma_is_the_users_else_the_rasters_own_else_that_of_airborne_lidar) {
  RasterFixture stated = hills(20, 20);
  stated.adjust = [](GDALDataset& d) { d.SetMetadataItem("DTED_VerticalAccuracy_ACC", "0004"); };
  const auto sigma = [&](const fs::path& file, const std::string& name, const RasterPriorOptions& raster) { return points_of(build({file}, {}, name, 1, raster)).sigma_m.front(); };
  const fs::path file = write(stated, "stated.tif");
  EXPECT_NEAR(sigma(file, "own", {}), std::hypot(4 / 1.645, 1 / std::sqrt(12.0)), 1e-3);
  EXPECT_NEAR(sigma(file, "users", {.sigma_m = 0.5}), 0.5, 1e-3);
  EXPECT_NEAR(sigma(write(hills(20, 20), "silent.tif"), "default", {}), std::hypot(0.15, 1 / std::sqrt(12.0)), 1e-3);
}

TEST_F(RasterPriorTest, the_bytes_do_not_depend_on_threads_or_order_of_inputs) {
  const fs::path west = write(hills(), "west.tif");
  RasterFixture shifted = hills();
  shifted.transform[0] += 600;
  const fs::path east = write(shifted, "east.tif");
  const auto one = bytes_of(build({west, east}, {}, "one", 1)), two = bytes_of(build({east, west, east}, {}, "two", 3));
  EXPECT_EQ(one, two);
}

TEST_F(RasterPriorTest, boxes_that_share_edges_share_out_the_points) {
  const fs::path file = write(hills(), "dem.tif");
  const auto count = [&](std::vector<double> bbox, const std::string& name) {
    PriorOptions options;
    options.bbox = std::move(bbox);
    build({file}, options, name);
    return report_.manifest.num_points;
  };
  // 11.57 E and 48.145 N cross the raster.
  EXPECT_EQ(count({11, 48, 11.57, 49}, "west") + count({11.57, 48, 12, 49}, "east"), 350000u);
}

TEST_F(RasterPriorTest, a_box_changes_no_point_inside) {
  const fs::path file = write(hills(), "dem.tif");
  PriorOptions options;
  options.bbox = {691100, 5335700, 691300, 5335900};
  options.bbox_crs = "EPSG:32632";
  const PointCloud part = points_of(build({file}, options, "part")), all = points_of(build({file}, {}, "all"));
  std::map<std::tuple<double, double, double>, Eigen::Vector3f> by_position;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Eigen::Vector3d p = (all.position(i) * 1000).array().round();
    by_position[{p.x(), p.y(), p.z()}] = all.normal[i];
  }
  ASSERT_EQ(part.size(), 40000u);
  for (std::size_t i = 0; i < part.size(); ++i) {
    const Eigen::Vector3d p = (part.position(i) * 1000).array().round();
    const auto found = by_position.find({p.x(), p.y(), p.z()});
    ASSERT_NE(found, by_position.end());
    ASSERT_EQ(found->second, part.normal[i]);
  }
}

TEST_F(RasterPriorTest, where_rasters_overlap_the_finer_has_the_word_except_in_its_holes) {
  RasterFixture coarse{.width = 50, .height = 50, .transform = {691000, 2, 0, 5336000, 0, -2}, .value = [](double, double) { return 100; }};
  RasterFixture fine{.width = 20, .height = 20, .transform = {691040, 1, 0, 5335960, 0, -1}, .no_data = -1,
                     .value = [](double col, double row) { return col < 10 && row < 10 ? -1 : 200; }};
  const PointCloud points = points_of(build({write(coarse, "coarse.tif"), write(fine, "fine.tif")}, {}, "prior"));
  std::size_t high = 0, low_in_hole = 0, low_in_data = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points.position(i) - Eigen::Vector3d(691040, 5335940, 0);
    const bool in_fine = p.x() > 0 && p.x() < 20 && p.y() > 0 && p.y() < 20;
    const bool in_hole = p.x() < 10 && p.y() > 10;
    if (p.z() > 150) ++high;
    else if (in_fine) ++(in_hole ? low_in_hole : low_in_data);
  }
  EXPECT_EQ(high, 300u);
  EXPECT_EQ(low_in_data, 0u);
  EXPECT_EQ(low_in_hole, 25u);
  EXPECT_EQ(points.size(), 300u + 2500 - 100 + 25);
}

TEST_F(RasterPriorTest, a_raster_that_another_covers_is_told_of_and_rims_are_not) {
  const fs::path ground = write(hills(100, 100), "dtm.tif");
  RasterFixture higher = hills(100, 100);
  higher.value = [](double, double) { return 520; };
  const fs::path surface = write(higher, "dsm.tif");
  const auto warning = [&](const std::vector<fs::path>& files, const std::string& name, int threads) {
    warnings_.clear();
    build(files, {}, name, threads);
    return warnings_.size() > 1 ? warnings_.back() : "";
  };
  const std::string told = warning({surface, ground}, "both", 2);
  EXPECT_NE(told.find(": 100 % of its points are left out where "), std::string::npos) << told;
  EXPECT_NE(told.find("--kind terrain"), std::string::npos) << told;
  EXPECT_EQ(warning({ground, surface}, "turned", 1), told) << "whatever the order and the threads";
  RasterFixture beside = hills(100, 100);
  beside.transform[0] += 95;
  EXPECT_EQ(warning({ground, write(beside, "next.tif")}, "tiles", 2), "");
  beside.transform[0] -= 45;
  EXPECT_NE(warning({ground, write(beside, "half.tif")}, "half", 2).find(": 50 % of its points"), std::string::npos);
}

TEST_F(RasterPriorTest, declared_heights_are_transformed_and_the_operation_is_recorded) {
  PriorOptions options = with_crs("EPSG:32632+5773");
  options.source_crs = "EPSG:4979";
  RasterFixture ellipsoidal{.transform = {11.57, 1e-5, 0, 48.15, 0, -1e-5}, .crs = "EPSG:4326", .value = [](double, double) { return 500; }};
  const PointCloud points = points_of(build({write(ellipsoidal, "dem.tif")}, options, "prior"));
  EXPECT_NEAR(points.position(0).z(), 454.456, 0.01) << "500 m above the ellipsoid near Munich, above EGM96";
  EXPECT_EQ(report_.manifest.vertical, "EPSG:5773");
  EXPECT_FALSE(report_.manifest.sources[0].operation.grids.empty());
}

TEST_F(RasterPriorTest, the_users_word_on_heights_is_recorded) {
  PriorOptions options = with_crs("EPSG:32632+5773");
  options.assume_vertical = "EPSG:5773";
  build({write(hills(20, 20), "dem.tif")}, options, "prior");
  EXPECT_EQ(report_.manifest.sources[0].assumed_vertical, "EPSG:5773");
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(RasterPriorTest, an_inaccurate_operation_is_warned_of) {
  PriorOptions options;
  options.source_crs = "EPSG:27700";
  build({write({.transform = {532000, 1, 0, 182000, 0, -1}, .crs = ""}, "dem.tif")}, options, "prior");
  ASSERT_EQ(warnings_.size(), 2u);
  EXPECT_NE(warnings_[1].find("accurate to 2 m only; --crs EPSG:27700 avoids it"), std::string::npos) << warnings_[1];
}

TEST_F(RasterPriorTest, spacing_thins_or_densifies) {
  PriorOptions options;
  options.spacing_m = 5;
  build({write(hills(100, 100), "dem.tif")}, options, "prior");
  EXPECT_EQ(report_.manifest.num_points, 400u);
  EXPECT_EQ(report_.manifest.spacing_m, 5);
}

TEST_F(RasterPriorTest, voids_that_the_file_does_not_declare_are_left_out_and_told_of_once) {
  RasterFixture voids = hills(300, 200);
  voids.value = [](double col, double row) { return col < 150 && row < 100 ? -9999 : 500; };
  const fs::path file = write(voids, "dem.tif");
  const auto expect_left_out = [&](const std::string& name, const PriorOptions& options, std::size_t num_points) {
    warnings_.clear();
    const PointCloud points = points_of(build({file}, options, name));
    EXPECT_EQ(points.size(), num_points);
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(points.position(i).z(), 500);
    ASSERT_EQ(warnings_.size(), 2u) << "and that heights are undeclared";
    EXPECT_NE(warnings_[1].find("dem.tif: 15000 of the cells read hold -9999, which is no height on Earth; they are left out"), std::string::npos) << warnings_[1];
    EXPECT_NE(warnings_[1].find("gdal_translate -a_nodata -9999"), std::string::npos) << warnings_[1];
  };
  expect_left_out("cells", {}, 45000);
  PriorOptions lattice;
  lattice.spacing_m = 1;
  expect_left_out("lattice", lattice, 45000);
}

TEST_F(RasterPriorTest, voids_too_scattered_to_count_are_told_of_without_a_number) {
  const std::string all = text_of("dem.tif", {.cells = 12, .lowest = -9999, .highest = -9999}), some = text_of("dem.tif", {.cells = 12, .are_more = true, .lowest = -9999, .highest = -9999});
  EXPECT_TRUE(all.starts_with("dem.tif: 12 of the cells read hold -9999,")) << all;
  EXPECT_TRUE(some.starts_with("dem.tif: millions of the cells read hold -9999,")) << some;
}

TEST_F(RasterPriorTest, voids_are_named_by_digits_that_read_back_as_the_same_value) {
  const auto advice = [&](double value, GDALDataType type, const std::string& name) {
    RasterFixture voids = hills(20, 20);
    voids.type = type;
    voids.value = [=](double col, double) { return col < 5 ? value : 500; };
    const fs::path file = write(voids, name + ".tif");
    warnings_.clear();
    build({file}, {}, name);
    const std::string text = warnings_.back(), before = "gdal_translate -a_nodata ";
    const std::size_t start = text.find(before) + before.size();
    const std::string digits = text.substr(start, text.find(' ', start) - start);

    auto* raster = GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE);
    raster->GetRasterBand(1)->SetNoDataValue(std::stod(digits));
    GDALClose(raster);
    warnings_.clear();
    EXPECT_EQ(points_of(build({file}, {}, name + "-declared")).size(), 300u);
    EXPECT_EQ(warnings_.size(), 1u) << "that heights are undeclared";
    return digits;
  };
  EXPECT_EQ(std::stof(advice(-FLT_MAX, GDT_Float32, "lowest_float")), -FLT_MAX);
  EXPECT_EQ(std::stod(advice(-FLT_MAX, GDT_Float64, "lowest_float_as_double")), -FLT_MAX);
  EXPECT_EQ(std::stod(advice(-DBL_MAX, GDT_Float64, "lowest_double")), -DBL_MAX);
  EXPECT_EQ(advice(-9999999, GDT_Float32, "seven_nines"), "-9999999");
  EXPECT_EQ(advice(-9999999, GDT_Int32, "seven_nines_of_an_integer"), "-9999999");
  EXPECT_EQ(advice(-9999.9, GDT_Float32, "with_a_fraction"), "-9999.9");
  EXPECT_EQ(advice(-2147483648.0, GDT_Int32, "lowest_integer"), "-2147483648");
}

TEST_F(RasterPriorTest, voids_in_a_box_are_told_of_without_a_look_at_what_lies_outside) {
  const fs::path file = write_mosaic_with_a_lost_east(folder_, [](double col, double row) { return col >= 20 && col < 30 && row < 50 ? -9999 : 500; });
  PriorOptions options;
  options.bbox = {500010, 4999900, 500090, 5000000};
  options.bbox_crs = "EPSG:32632";
  EXPECT_EQ(points_of(build({file}, options, "prior")).size(), 80u * 100 - 10 * 50);
  ASSERT_EQ(warnings_.size(), 2u) << "and that heights are undeclared";
  EXPECT_NE(warnings_[1].find("mosaic.vrt: 500 of the cells read hold -9999"), std::string::npos) << warnings_[1];
}

TEST_F(RasterPriorTest, heights_in_another_unit_are_an_error_that_says_so) {
  RasterFixture millimetres = hills(20, 20);
  millimetres.value = [](double col, double) { return 500000 + col; };
  try {
    build({write(millimetres, "dem.tif")}, {}, "prior");
    FAIL();
  } catch (const FormatError& error) {
    EXPECT_NE(std::string(error.what()).find("400 of the cells read hold values from 500000 to 500019"), std::string::npos) << error.what();
  }
}

TEST_F(RasterPriorTest, a_unit_that_is_none_of_length_is_told_of) {
  RasterFixture fixture = hills(10, 10);
  fixture.adjust = [](GDALDataset& d) { d.GetRasterBand(1)->SetUnitType("points"); };
  build({write(fixture, "odd.tif")}, with_crs("EPSG:32632"), "prior");
  EXPECT_TRUE(std::ranges::any_of(warnings_, [](const std::string& warning) { return warning.find("odd.tif: its heights are in 'points'") != std::string::npos; }));
}

TEST_F(RasterPriorTest, nothing_to_write_is_an_error_and_leaves_nothing) {
  const fs::path file = write(hills(20, 20), "dem.tif");
  PriorOptions options;
  options.bbox = {7, 43, 8, 44};
  EXPECT_THROW(build({file}, options, "prior"), FormatError);
  RasterFixture empty = hills(20, 20);
  empty.value = [](double, double) { return std::nan(""); };
  EXPECT_THROW(build({write(empty, "empty.tif")}, {}, "prior"), FormatError);
  for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_TRUE(entry.path().extension() == ".tif") << entry.path();
}

}  // namespace
}  // namespace priormap
