#include <priormap/sources/height_raster.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/transformer.hpp>

#include "raster_fixture.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class HeightRasterTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "priormap_raster_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const RasterFixture& fixture, const std::string& name = "dem.tif") {
    fixture.write(folder_ / name);
    return folder_ / name;
  }
  static HeightRaster open(const fs::path& file, const std::string& target = "EPSG:32632") {
    return HeightRaster::open(file, std::nullopt, Crs::parse(target));
  }

  fs::path folder_;
};

fs::path shared_data(const std::string& name) {
  const char* folder = std::getenv("PRIORMAP_SHARED_DATA");
  const fs::path file = fs::path(folder ? folder : PRIORMAP_SOURCE_DIR "/../shared/data") / name;
  return fs::exists(file) ? file : fs::path();
}

/// z = 1 + 0.5 x - 0.25 y of the cell's centre, x and y from the raster's corner.
double plane(double col, double row) { return 1 + 0.5 * (col + 0.5) - 0.25 * (row + 0.5); }

TEST_F(HeightRasterTest, a_plane_is_answered_exactly_between_the_cell_centres) {
  const HeightRaster raster = open(write({.value = plane}));
  for (double x = 0.5; x < 9.5; x += 0.37)
    for (double y = 0.5; y < 7.5; y += 0.41) EXPECT_NEAR(raster.at(500000 + x, 5000000 - y).value(), 1 + 0.5 * x - 0.25 * y, 1e-6);
}

TEST_F(HeightRasterTest, half_a_cell_at_the_edge_takes_the_edge_cell_and_outside_is_nothing) {
  const HeightRaster raster = open(write({.value = plane}));
  EXPECT_NEAR(raster.at(500000, 5000000).value(), plane(0, 0), 1e-6);
  EXPECT_NEAR(raster.at(500010, 4999992).value(), plane(9, 7), 1e-6);
  EXPECT_FALSE(raster.at(499999.99, 4999995));
  EXPECT_FALSE(raster.at(500005, 5000000.01));
  EXPECT_FALSE(raster.at(nan, 4999995));
}

TEST_F(HeightRasterTest, pixel_is_point_and_pixel_is_area_files_are_told_apart) {
  // The same tie point (500000, 5000000): of the first cell's corner, or of its centre.
  const auto with_interpretation = [&](const char* word) {
    return write({.transform = {500000, 1, 0, 5000000, 0, -1}, .value = plane,
                  .adjust = [&](GDALDataset& d) { d.SetMetadataItem("AREA_OR_POINT", word); }},
                 std::string(word) + ".tif");
  };
  // GDAL's geotransform is that of the corner in both cases, whatever the file's tags say inside.
  EXPECT_NEAR(open(with_interpretation("Area")).at(500003.5, 4999996.5).value(), plane(3, 3), 1e-6);
  EXPECT_NEAR(open(with_interpretation("Point")).at(500003.5, 4999996.5).value(), plane(3, 3), 1e-6);
}

TEST_F(HeightRasterTest, srtm_tiles_have_their_samples_on_whole_arc_seconds) {
  const fs::path file = shared_data("dem/N43E007.hgt.zip");
  if (file.empty()) GTEST_SKIP() << "the real inputs are absent";
  const RasterFacts facts = read_raster_facts(file);
  EXPECT_EQ(facts.width, 1201);
  EXPECT_NEAR(facts.bounds.min_x, 7 - 0.5 / 1200, 1e-9);
  EXPECT_NEAR(facts.bounds.max_y, 44 + 0.5 / 1200, 1e-9);
  const HeightRaster raster = open(file, "EPSG:4326");
  auto* dataset = GDALDataset::Open(("/vsizip/" + file.string() + "/N43E007.hgt").c_str(), GDAL_OF_RASTER);
  ASSERT_NE(dataset, nullptr);
  for (const int col : {1, 500, 777}) {
    double sample = 0;
    ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, col, 280, 1, 1, &sample, 1, 1, GDT_Float64, 0, 0, nullptr), CE_None);
    EXPECT_NEAR(raster.at(7 + col / 1200.0, 44 - 280 / 1200.0).value(), sample, 1e-6);
  }
  GDALClose(dataset);
}

TEST_F(HeightRasterTest, gauss_krueger_whose_authority_names_northing_first_has_east_along_the_rows) {
  const HeightRaster raster = open(write({.transform = {4468000, 1, 0, 5334000, 0, -1}, .crs = "EPSG:31468", .value = plane}, "krueger.tif"), "EPSG:31468");
  EXPECT_NEAR(raster.at(4468003.5, 5333996.5).value(), plane(3, 3), 1e-6);
  EXPECT_FALSE(raster.at(5333996.5, 4468003.5));
}

TEST_F(HeightRasterTest, dted_files_and_their_copies_state_their_accuracy) {
  constexpr double step = 1.0 / 120;   // level 0: a degree in 121 x 121 posts
  const auto stating = [&](const char* accuracy) {
    return write({.width = 121, .height = 121, .transform = {7 - step / 2, step, 0, 44 + step / 2, 0, -step}, .crs = "EPSG:4326", .type = GDT_Int16,
                  .adjust = [&](GDALDataset& d) { if (accuracy) d.SetMetadataItem("DTED_VerticalAccuracy_ACC", accuracy); }},
                 std::string(accuracy ? accuracy : "silent") + ".tif");
  };
  const fs::path copy = stating("0016");
  auto* tiff = GDALDataset::Open(copy.c_str(), GDAL_OF_RASTER);
  ASSERT_NE(tiff, nullptr);
  const fs::path dted = fs::path(copy).replace_filename("n43.dt0");
  GDALClose(GetGDALDriverManager()->GetDriverByName("DTED")->CreateCopy(dted.c_str(), tiff, FALSE, nullptr, nullptr, nullptr));
  GDALClose(tiff);
  EXPECT_NEAR(read_raster_facts(copy).height_sigma_m.value(), 16 / 1.645, 1e-9);
  EXPECT_NEAR(read_raster_facts(dted).height_sigma_m.value(), 16 / 1.645, 1e-9);
  EXPECT_FALSE(read_raster_facts(stating("NA  ")).height_sigma_m);
  EXPECT_FALSE(read_raster_facts(stating(nullptr)).height_sigma_m);
}

TEST_F(HeightRasterTest, every_way_to_say_no_data_is_understood) {
  const auto hole = [](double value) { return [value](double col, double row) { return col == 5 && row == 4 ? value : plane(col, row); }; };
  const auto expect_hole = [&](const RasterFixture& fixture, const std::string& name) {
    const HeightRaster raster = open(write(fixture, name));
    EXPECT_FALSE(raster.at(500005.5, 4999995.5)) << name;
    EXPECT_TRUE(raster.at(500004.5, 4999995.5)) << name;
    std::size_t count = 0;
    raster.for_each_inside({500000, 4999992, 500010, 5000000}, [&](double, double, double) { ++count; });
    EXPECT_EQ(count, 79u) << name;
  };
  expect_hole({.no_data = -9999, .value = hole(-9999)}, "declared.tif");
  expect_hole({.type = GDT_Float64, .no_data = -9999, .value = hole(-9999)}, "double.tif");
  expect_hole({.type = GDT_Int16, .no_data = -32768, .value = hole(-32768)}, "integer.tif");
  expect_hole({.value = hole(nan)}, "not_a_number.tif");
  expect_hole({.no_data = nan, .value = hole(nan)}, "declared_not_a_number.tif");
  expect_hole({.no_data = -3.402823e+38, .value = hole(-3.4028234663852886e+38)}, "rounded.tif");
  expect_hole({.value = hole(-3.4e38)}, "undeclared_lowest_float.tif");
  expect_hole({.value = hole(std::numeric_limits<double>::infinity())}, "infinite.tif");
}

TEST_F(HeightRasterTest, values_that_are_no_height_on_earth_are_no_data_and_counted) {
  const auto with_hole = [](double value) { return [value](double col, double) { return col < 3 ? value : 100; }; };
  const auto met = [&](const RasterFixture& fixture, const std::string& name, const std::optional<Crs>& source = std::nullopt) {
    const HeightRaster raster = HeightRaster::open(write(fixture, name), source, Crs::parse("EPSG:32632"));
    EXPECT_EQ(raster.impossible_heights().cells, 0u) << "nothing is read yet";
    const HeightRaster copy = raster;
    const bool is_height = copy.at(500001.5, 4999995.5).has_value() || fixture.no_data;
    EXPECT_TRUE(copy.at(500005.5, 4999995.5));
    const ImpossibleHeights impossible = raster.impossible_heights();
    EXPECT_EQ(impossible.cells, is_height ? 0u : 24u) << name;
    return impossible;
  };
  EXPECT_EQ(met({.value = with_hole(-9999)}, "voids.tif").lowest, -9999);
  EXPECT_EQ(met({.type = GDT_Int16, .value = with_hole(32767)}, "highest_short.tif").highest, 32767);
  EXPECT_EQ(met({.value = with_hole(-430)}, "dead_sea.tif").cells, 0u);
  EXPECT_EQ(met({.value = with_hole(8849)}, "everest.tif").cells, 0u);
  EXPECT_EQ(met({.no_data = -9999, .value = with_hole(-9999)}, "declared.tif").cells, 0u);
  EXPECT_EQ(met({.value = with_hole(29000)}, "everest_in_feet.tif", Crs::parse("EPSG:32632+6360")).cells, 0u);
  EXPECT_EQ(met({.value = with_hole(29000)}, "too_high_in_metres.tif", Crs::parse("EPSG:32632+5773")).cells, 24u);
  EXPECT_EQ(met({.value = with_hole(5000), .adjust = [](GDALDataset& d) { d.GetRasterBand(1)->SetScale(0.1); }}, "decimetres.tif").cells, 0u);
}

TEST_F(HeightRasterTest, impossible_heights_are_those_of_the_cells_that_copies_have_read_each_counted_once) {
  const auto voids = [](double col, double row) { return row >= 3 && col >= 5 ? -9000 - col : 100; };
  const HeightRaster raster = open(write({.width = 300, .height = 200, .value = voids}));
  const auto found_after_asking = [&](double col, double row) {
    for (int copies = 0; copies < 2; ++copies) EXPECT_EQ(HeightRaster(raster).at(500000.5 + col, 4999999.5 - row).has_value(), voids(col, row) == 100);
    return raster.impossible_heights();
  };
  const ImpossibleHeights of_first_block = found_after_asking(2, 2);
  EXPECT_EQ(of_first_block.cells, (128u - 5) * (128 - 3));
  EXPECT_EQ(of_first_block.lowest, -9127);
  EXPECT_EQ(of_first_block.highest, -9005);
  for (const auto& [col, row] : {std::pair(299, 0), {2, 199}, {150, 2}, {150, 150}, {299, 199}}) found_after_asking(col, row);
  EXPECT_EQ(raster.impossible_heights().cells, (300u - 5) * (200 - 3));
  EXPECT_EQ(raster.impossible_heights().lowest, -9299);
}

TEST_F(HeightRasterTest, what_nobody_asks_for_is_not_read_to_count_impossible_heights) {
  const HeightRaster raster = open(write_mosaic_with_a_lost_east(folder_, [](double col, double) { return col < 3 ? -9999 : 100; }));
  EXPECT_TRUE(raster.at(500100.5, 4999950.5));
  EXPECT_EQ(raster.impossible_heights().cells, 3u * 100);
  EXPECT_THROW(raster.at(500900.5, 4999950.5), FormatError);
}

TEST_F(HeightRasterTest, a_mask_band_hides_cells) {
  CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
  const fs::path file = write({.value = plane});
  auto* dataset = GDALDataset::Open(file.c_str(), GDAL_OF_UPDATE);
  ASSERT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
  std::vector<std::uint8_t> mask(80, 255);
  mask[4 * 10 + 5] = 0;
  ASSERT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 10, 8, mask.data(), 10, 8, GDT_Byte, 0, 0, nullptr), CE_None);
  GDALClose(dataset);
  const HeightRaster raster = open(file);
  EXPECT_FALSE(raster.at(500005.5, 4999995.5));
  EXPECT_TRUE(raster.at(500004.5, 4999995.5));
}

TEST_F(HeightRasterTest, scale_and_offset_of_the_band_are_applied_and_no_data_is_the_raw_value) {
  const HeightRaster raster = open(write({.type = GDT_Int16,
                                          .no_data = 0,
                                          .value = [](double col, double row) { return col == 5 && row == 4 ? 0 : 10 * col; },
                                          .adjust =
                                              [](GDALDataset& d) {
                                                d.GetRasterBand(1)->SetScale(0.1);
                                                d.GetRasterBand(1)->SetOffset(200);
                                              }}));
  EXPECT_NEAR(raster.at(500003.5, 4999995.5).value(), 203, 1e-9);
  EXPECT_FALSE(raster.at(500005.5, 4999995.5));
}

TEST_F(HeightRasterTest, undeclared_heights_in_feet_become_metres) {
  const fs::path file = write({.value = [](double, double) { return 100; }, .adjust = [](GDALDataset& d) { d.GetRasterBand(1)->SetUnitType("ft"); }});
  EXPECT_NEAR(open(file).at(500003.5, 4999995.5).value(), 30.48, 1e-9);
  const HeightRaster named = HeightRaster::open(file, Crs::parse("EPSG:32632+6360"), Crs::parse("EPSG:32632"));
  EXPECT_NEAR(named.at(500003.5, 4999995.5).value(), 100 * 0.3048 / (1200.0 / 3937), 1e-9) << "feet of the file become those of the vertical CRS that the user names";
}

TEST_F(HeightRasterTest, undeclared_heights_in_any_unit_of_length_become_metres) {
  const auto with_unit = [&](const std::string& unit, const std::string& crs = "EPSG:32632") {
    return write({.crs = crs, .value = [](double, double) { return 350; }, .adjust = [&](GDALDataset& d) { d.GetRasterBand(1)->SetUnitType(unit.c_str()); }});
  };
  for (const auto& [unit, height_m] : {std::pair("cm", 3.5), {"dm", 35.0}, {"Millimeters", 0.35}, {"[m]", 350.0}, {"US survey foot", 350 * 1200.0 / 3937}, {"fathom", 350 * 1.8288}, {"", 350.0}, {"points", 350.0}}) {
    const fs::path file = with_unit(unit);
    EXPECT_NEAR(open(file).at(500003.5, 4999995.5).value(), height_m, 1e-9) << unit;
    EXPECT_EQ(read_raster_facts(file).unknown_height_unit, std::string(unit) == "points" ? unit : "");
  }
  EXPECT_NEAR(open(with_unit("cm", "EPSG:32632+5773")).at(500003.5, 4999995.5).value(), 3.5, 1e-9) << "no vertical CRS counts in centimetres: the band's word adds to it";
  EXPECT_NEAR(open(with_unit("ft", "EPSG:32632+5773")).at(500003.5, 4999995.5).value(), 350, 1e-9) << "the CRS has the word";
}

TEST_F(HeightRasterTest, south_up_and_rotated_rasters) {
  const HeightRaster south_up = open(write({.transform = {500000, 1, 0, 4999992, 0, 1}, .value = plane}, "south_up.tif"));
  EXPECT_NEAR(south_up.at(500003.5, 4999992 + 2.5).value(), plane(3, 2), 1e-6);
  const double c = std::cos(0.3), s = std::sin(0.3);
  const HeightRaster rotated = open(write({.transform = {500000, c, s, 5000000, s, -c}, .value = plane}, "rotated.tif"));
  EXPECT_NEAR(rotated.at(500000 + c * 3.5 + s * 2.5, 5000000 + s * 3.5 - c * 2.5).value(), plane(3, 2), 1e-6);
  EXPECT_NEAR(rotated.cell_size(), 1, 1e-9);
}

TEST_F(HeightRasterTest, cells_inside_bounds_are_those_whose_centre_is_inside_half_open) {
  const HeightRaster raster = open(write({.value = plane}));
  std::vector<Eigen::Vector3d> cells;
  raster.for_each_inside({500002.5, 4999995.5, 500004.5, 4999996.5}, [&](double x, double y, double z) { cells.emplace_back(x, y, z); });
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0], Eigen::Vector3d(500002.5, 4999995.5, plane(2, 4)));
  EXPECT_EQ(cells[1], Eigen::Vector3d(500003.5, 4999995.5, plane(3, 4)));
}

TEST_F(HeightRasterTest, answers_in_another_crs_at_the_same_place) {
  const HeightRaster raster = open(write({.width = 100, .height = 100, .transform = {690000, 10, 0, 5336000, 0, -10}, .value = plane}), "EPSG:4326");
  const Transformer to_lon_lat(Crs::parse("EPSG:32632"), Crs::parse("EPSG:4326"));
  const Eigen::Vector3d p = to_lon_lat.forward(Eigen::Vector3d(690335, 5335735, 0));
  EXPECT_NEAR(raster.at(p.x(), p.y()).value(), plane(33, 26), 1e-5);
  std::size_t count = 0;
  raster.for_each_inside({p.x() - 1e-5, p.y() - 1e-5, p.x() + 1e-5, p.y() + 1e-5}, [&](double x, double y, double z) {
    EXPECT_NEAR(x, p.x(), 1e-9);
    EXPECT_NEAR(y, p.y(), 1e-9);
    EXPECT_NEAR(z, plane(33, 26), 1e-6);
    ++count;
  });
  EXPECT_EQ(count, 1u);
}

TEST_F(HeightRasterTest, heights_are_transformed_between_declared_vertical_systems) {
  const HeightRaster raster = HeightRaster::open(write({.transform = {690000, 1, 0, 5336000, 0, -1}, .value = [](double, double) { return 500; }}),
                                                 Crs::parse("EPSG:32632+5773"), Crs::parse("EPSG:4979"));
  const Transformer to_geographic(Crs::parse("EPSG:32632+5773"), Crs::parse("EPSG:4979"));
  const Eigen::Vector3d p = to_geographic.forward(Eigen::Vector3d(690005, 5335995, 500));
  EXPECT_GT(p.z(), 540) << "the EGM96 undulation near Munich is 45 m";
  EXPECT_NEAR(raster.at(p.x(), p.y()).value(), p.z(), 1e-3);
}

TEST_F(HeightRasterTest, undeclared_heights_are_never_taken_for_declared_ones) {
  EXPECT_THROW(open(write({}), "EPSG:32632+5773"), CrsError);
  EXPECT_THROW(open(write({.crs = ""}, "none.tif")), CrsError);
  EXPECT_NO_THROW(HeightRaster::open(folder_ / "none.tif", Crs::parse("EPSG:32632"), Crs::parse("EPSG:32632")));
}

TEST_F(HeightRasterTest, blocks_of_a_large_raster_agree_with_its_cells) {
  const HeightRaster raster = open(write({.width = 3000, .height = 2100, .value = [](double col, double row) { return col * 0.01 + row; }}));
  HeightRaster copy = raster;
  for (int k = 0; k < 1000; ++k) {
    const int col = (k * 7919) % 2999, row = (k * 104729) % 2099;
    ASSERT_NEAR(copy.at(500000 + col + 0.5, 5000000 - row - 0.5).value(), col * 0.01 + row, 2e-4);
  }
}

TEST_F(HeightRasterTest, a_picture_is_no_raster_of_heights) {
  EXPECT_NO_THROW(read_raster_facts(write({.type = GDT_Byte}, "gray.tif"))) << "whole metres of flat land";
  for (const auto& [colour, name] : {std::pair(GCI_RedBand, "rgb.tif"), {GCI_PaletteIndex, "palette.png"}}) {
    const fs::path file = folder_ / name;
    auto* memory = GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 10, 8, colour == GCI_RedBand ? 3 : 1, GDT_Byte, nullptr);
    double transform[6] = {500000, 1, 0, 5000000, 0, -1};
    memory->SetGeoTransform(transform);
    GDALColorTable colours;
    const GDALColorEntry black = {0, 0, 0, 255};
    colours.SetColorEntry(0, &black);
    if (colour == GCI_PaletteIndex) memory->GetRasterBand(1)->SetColorTable(&colours);
    if (colour == GCI_RedBand)
      for (int band = 1; band <= 3; ++band) memory->GetRasterBand(band)->SetColorInterpretation(GDALColorInterp(GCI_RedBand + band - 1));
    GDALClose(GetGDALDriverManager()->GetDriverByName(colour == GCI_RedBand ? "GTiff" : "PNG")->CreateCopy(file.c_str(), memory, false, nullptr, nullptr, nullptr));
    GDALClose(memory);
    try {
      read_raster_facts(file);
      ADD_FAILURE() << name;
    } catch (const FormatError& error) {
      EXPECT_NE(std::string(error.what()).find(std::string(name) + ": is a picture"), std::string::npos) << error.what();
    }
  }
}

TEST_F(HeightRasterTest, unusable_files_are_named_with_the_cause) {
  EXPECT_THROW(open(folder_ / "none.tif"), IoError);
  std::ofstream(folder_ / "text.tif") << "no raster";
  EXPECT_THROW(open(folder_ / "text.tif"), FormatError);
  const fs::path plain = folder_ / "plain.png";
  auto* memory = GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 4, 4, 1, GDT_Byte, nullptr);
  GDALClose(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(plain.c_str(), memory, false, nullptr, nullptr, nullptr));
  GDALClose(memory);
  try {
    open(plain);
    FAIL();
  } catch (const FormatError& error) {
    EXPECT_NE(std::string(error.what()).find("no georeference"), std::string::npos);
  }
  const fs::path cut = write({.width = 1000, .height = 1000}, "cut.tif");
  fs::resize_file(cut, fs::file_size(cut) / 2);
  const HeightRaster raster = open(cut);
  EXPECT_THROW(raster.at(500500.5, 5000000 - 900.5), FormatError);
}

}  // namespace
}  // namespace priormap
