#include <cpl_conv.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gtest/gtest.h>

#include <fstream>
#include <priormap/core/error.hpp>
#include <priormap/sources/ogr_footprints.hpp>
#include <priormap/sources/ogr_lines.hpp>
#include <priormap/tessellation/normalize.hpp>

namespace priormap {
namespace {

namespace fs = std::filesystem;

class OgrFootprints : public testing::Test {
 protected:
  OgrFootprints() : folder_(fs::path(testing::TempDir()) / (std::string("ogr_") + testing::UnitTest::GetInstance()->current_test_info()->name())) { fs::create_directories(folder_); }
  ~OgrFootprints() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  fs::path write_features(const std::string& features) {
    return write("town.geojson", R"({"type":"FeatureCollection","name":"town","features":[)" + features + "]}");
  }
  static std::string feature(const std::string& properties, const std::string& geometry) {
    return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":)" + geometry + "}";
  }
  struct Layers {
    std::vector<Footprint> footprints;
    std::optional<Crs> crs;
  };
  Layers read(const fs::path& file, const FootprintFields& fields) {
    FootprintList list;
    const std::optional<Crs> crs = read_ogr_footprints(file, fields, diagnostics_, list);
    return {{list.begin(), list.end()}, crs};
  }

  static void write_shapefile(const fs::path& from, const fs::path& to) {
    GDALAllRegister();
    GDALDatasetH source = GDALOpenEx(from.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr);
    GDALVectorTranslateOptions* options = GDALVectorTranslateOptionsNew(nullptr, nullptr);
    GDALClose(GDALVectorTranslate(to.c_str(), nullptr, 1, &source, options, nullptr));
    GDALVectorTranslateOptionsFree(options);
    GDALClose(source);
  }

  fs::path folder_;
  Diagnostics diagnostics_;
};

const std::string square = R"({"type":"Polygon","coordinates":[[[11,48],[11.001,48],[11.001,48.001],[11,48.001],[11,48]]]})";
const std::string two_squares = R"({"type":"MultiPolygon","coordinates":[[[[11,48],[11.001,48],[11.001,48.001],[11,48]],[[11.0005,48.0001],[11.0006,48.0001],[11.0006,48.0002],[11.0005,48.0001]]],
  [[[12,48],[12.001,48],[12.001,48.001],[12,48]]]]})";

TEST_F(OgrFootprints, PolygonsWithHeightsAndLevels) {
  const fs::path file = write_features(feature(R"("h":12.5,"storeys":3,"key":"A7")", square) + "," + feature(R"("h":null,"storeys":0,"key":null)", two_squares));
  const Layers layers = read(file, {"", "h", "storeys", ""});
  ASSERT_EQ(layers.footprints.size(), 2u);
  ASSERT_TRUE(layers.crs);
  EXPECT_TRUE(layers.crs->is_geographic());
  EXPECT_EQ(layers.footprints[0].id, "town/0");
  EXPECT_EQ(layers.footprints[0].attributes.height_m, 12.5);
  EXPECT_EQ(layers.footprints[0].attributes.levels, 3);
  EXPECT_EQ(layers.footprints[0].rings[0][1], Eigen::Vector2d(11.001, 48)) << "east before north";
  EXPECT_EQ(layers.footprints[1].rings.size(), 3u);
  EXPECT_FALSE(layers.footprints[1].attributes.height_m);
  EXPECT_FALSE(layers.footprints[1].attributes.levels);
  EXPECT_EQ(diagnostics_.counts().at(DiagnosticCode::unusable_height), 1u) << "no storeys at all is no count of them";
  EXPECT_EQ(read(file, {"", "", "", "key"}).footprints[0].id, "town/A7");
}

/// The point set of a multipolygon is that of all its polygons (OGC 06-103r4, 6.1.14): only rings of one polygon can be holes.
TEST_F(OgrFootprints, APolygonWithinAnotherOfAMultipolygonIsNoCourtyard) {
  const auto ring = [](double low, double high) {
    const std::string a = std::to_string(11 + low), b = std::to_string(11 + high);
    return "[[" + a + "," + a + "],[" + b + "," + a + "],[" + b + "," + b + "],[" + a + "," + b + "],[" + a + "," + a + "]]";
  };
  const auto area_of = [&](const std::string& polygons) {
    const Layers layers = read(write_features(feature("", R"({"type":"MultiPolygon","coordinates":[)" + polygons + "]}")), {});
    double sum = 0;
    std::vector<Ring2> rings = layers.footprints.at(0).rings;
    for (Ring2& r : rings)
      for (Eigen::Vector2d& p : r) p = (p - Eigen::Vector2d(11, 11)) * 1000;
    for (const Polygon2& polygon : normalize(rings, "", diagnostics_)) sum += area(polygon);
    return sum;
  };
  const std::string block = "[" + ring(0, 0.010) + "]", with_yard = "[" + ring(0, 0.010) + "," + ring(0.002, 0.008) + "]";
  EXPECT_NEAR(area_of(block + ",[" + ring(0.004, 0.006) + "]"), 100, 1e-6) << "a polygon within another";
  EXPECT_NEAR(area_of(with_yard + ",[" + ring(0.004, 0.006) + "]"), 100 - 36 + 4, 1e-6) << "an island in the yard";
  EXPECT_NEAR(area_of(with_yard + ",[" + ring(0.004, 0.006) + "],[" + ring(0.0045, 0.0055) + "]"), 100 - 36 + 4, 1e-6) << "a polygon within the island";
  EXPECT_NEAR(area_of(block + ",[" + ring(0.005, 0.015) + "]"), 100 + 100 - 25, 1e-6) << "polygons that overlap";
  const std::string upright = "[[[11,11,0],[11,11.01,0],[11,11.01,5],[11,11,5],[11,11,0]]]", bow_tie = "[[[11.05,11],[11.06,11.01],[11.06,11],[11.05,11.01],[11.05,11]]]";
  EXPECT_NEAR(area_of(block + ",[" + ring(0.005, 0.015) + "]," + upright), 100 + 100 - 25, 1e-6) << "a wall beside them covers nothing";
  EXPECT_NEAR(area_of(block + ",[" + ring(0.005, 0.015) + "]," + bow_tie), 100 + 100 - 25 + 50, 1e-6) << "one that is not in order stands for itself";
  EXPECT_NEAR(area_of(block + "," + block), 100, 1e-6) << "twice the same";
  EXPECT_EQ(diagnostics_.counts().at(DiagnosticCode::intersection_rings), 6u);
  EXPECT_NEAR(area_of(block + ",[" + ring(0.010, 0.012) + "]"), 100 + 4, 1e-6) << "polygons that touch in a corner";
  EXPECT_EQ(diagnostics_.counts().at(DiagnosticCode::intersection_rings), 6u);
}

/// As most offices hand them out.
TEST_F(OgrFootprints, AShapefileMayLieInAZipArchive) {
  const fs::path zip = folder_ / "town.zip";
  fs::create_directories(folder_ / "shapes");
  write_shapefile(write_features(feature(R"("h":12.5)", square)), folder_ / "shapes/town.shp");
  void* archive = CPLCreateZip(zip.c_str(), nullptr);
  for (const char* extension : {".shp", ".shx", ".dbf", ".prj"}) {
    std::ifstream stream(folder_ / "shapes" / (std::string("town") + extension), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    CPLCreateFileInZip(archive, (std::string("town") + extension).c_str(), nullptr);
    CPLWriteFileInZip(archive, bytes.data(), static_cast<int>(bytes.size()));
    CPLCloseFileInZip(archive);
  }
  CPLCloseZip(archive);
  for (const fs::path& file : {zip, fs::path("/vsizip/" + zip.string()), fs::path("/vsizip/" + zip.string() + "/town.shp")}) {
    const Layers layers = read(file, {"", "h", "", ""});
    ASSERT_EQ(layers.footprints.size(), 1u) << file;
    EXPECT_EQ(layers.footprints[0].attributes.height_m, 12.5);
    EXPECT_TRUE(layers.crs);
  }
}

TEST_F(OgrFootprints, HeightsAsTextCarryTheirUnits) {
  const fs::path file = write_features(feature(R"("h":"30 ft")", square) + "," + feature(R"("h":"unknown")", square));
  const Layers layers = read(file, {"", "h", "", ""});
  EXPECT_NEAR(*layers.footprints[0].attributes.height_m, 9.144, 1e-9);
  EXPECT_FALSE(layers.footprints[1].attributes.height_m);
  EXPECT_EQ(diagnostics_.total(), 1u);
}

TEST_F(OgrFootprints, WhatIsNoPolygonIsCounted) {
  const fs::path file = write_features(feature("", square) + "," + feature("", R"({"type":"Point","coordinates":[11,48]})") + "," + feature("", "null"));
  EXPECT_EQ(read(file, {}).footprints.size(), 1u);
  EXPECT_EQ(diagnostics_.counts().at(DiagnosticCode::too_few_points), 2u);
}

TEST_F(OgrFootprints, UnusableFilesAreNamed) {
  EXPECT_THROW(read(folder_ / "absent.gpkg", {}), IoError);
  EXPECT_THROW(read(write("text.shp", "no shapes"), {}), FormatError);
  EXPECT_THROW(read(write("cut.geojson", R"({"type":"FeatureCollection","features":[{"type":"Fea)"), {}), FormatError);
  const fs::path points = write_features(feature("", R"({"type":"Point","coordinates":[11,48]})"));
  EXPECT_THROW(read(points, {}), FormatError);
  const fs::path file = write_features(feature(R"("h":3)", square));
  EXPECT_THROW(read(file, {"other", "", "", ""}), UsageError);
  try {
    read(file, {"", "height", "", ""});
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("it has: h"), std::string::npos) << error.what();
  }
}

/// GDAL itself writes what is read back.
TEST_F(OgrFootprints, EveryFormatGivesTheSameOutlines) {
  const fs::path file = write_features(feature(R"("h":12.5)", square) + "," + feature(R"("h":7)", two_squares));
  const std::vector<Footprint> expected = read(file, {"", "h", "", ""}).footprints;
  for (const char* name : {"town.gpkg", "town.shp", "town.fgb"}) {
    auto* source = GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR);
    GDALDatasetH handle = source;
    GDALClose(GDALVectorTranslate((folder_ / name).c_str(), nullptr, 1, &handle, nullptr, nullptr));
    GDALClose(source);
    const Layers layers = read(folder_ / name, {"", "h", "", ""});
    ASSERT_TRUE(layers.crs) << name;
    std::vector<Footprint> found = layers.footprints;
    ASSERT_EQ(found.size(), 2u) << name;
    std::ranges::sort(found, {}, [](const Footprint& f) { return -*f.attributes.height_m; });  // FlatGeobuf orders by place
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(found[i].attributes.height_m, expected[i].attributes.height_m);
      ASSERT_EQ(found[i].rings.size(), expected[i].rings.size()) << name;
      double found_area = 0, expected_area = 0;
      for (const Ring2& ring : found[i].rings) found_area += std::abs(signed_area(ring));
      for (const Ring2& ring : expected[i].rings) expected_area += std::abs(signed_area(ring));
      EXPECT_NEAR(found_area, expected_area, 1e-15) << name;
    }
  }
}

/// EPSG names northing first for Gauss-Krueger; each format has its own habit, and GDAL says which.
TEST_F(OgrFootprints, EastComesBeforeNorthInGaussKruegerOfEveryFormat) {
  const std::string at_9_east = R"({"type":"Polygon","coordinates":[[[9,48],[9.001,48],[9.001,48.001],[9,48.001],[9,48]]]})";
  const fs::path file = write_features(feature("", at_9_east));
  GDALAllRegister();
  const char* words[] = {"-t_srs", "EPSG:31467", nullptr};
  for (const char* name : {"town.gpkg", "town.shp", "town.fgb", "town.gml", "projected.geojson"}) {
    auto* options = GDALVectorTranslateOptionsNew(const_cast<char**>(words), nullptr);
    auto* source = GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR);
    GDALDatasetH handle = source;
    GDALClose(GDALVectorTranslate((folder_ / name).c_str(), nullptr, 1, &handle, options, nullptr));
    GDALClose(source);
    GDALVectorTranslateOptionsFree(options);
    const Layers layers = read(folder_ / name, {});
    ASSERT_TRUE(layers.crs && layers.crs->is_projected()) << name;
    ASSERT_EQ(layers.footprints.size(), 1u) << name;
    const Eigen::Vector2d corner = layers.footprints[0].rings[0][0];
    EXPECT_NEAR(corner.x(), 3'500'070, 300) << name << ": on the central meridian, but for the datum";
    EXPECT_NEAR(corner.y(), 5'317'700, 1000) << name << ": the meridian's length to 48 degrees";
  }
}

TEST_F(OgrFootprints, LinesAndPointsOfATrackEastBeforeNorth) {
  const fs::path file = write_features(feature(R"("verdict":"anchored")", R"({"type":"LineString","coordinates":[[11,48,500],[11.001,48,500],[11.001,48.002,501]]})") + "," +
                                       feature("", R"({"type":"MultiLineString","coordinates":[[[12,49],[12.1,49]],[[13,49],[13.1,49]]]})") + "," +
                                       feature("", R"({"type":"Point","coordinates":[14,50]})") + "," + feature("", square));
  const LineLayers layers = read_ogr_lines(file);
  ASSERT_EQ(layers.lines.size(), 4u) << "polygons are no lines";
  ASSERT_EQ(layers.lines[0].size(), 3u);
  EXPECT_EQ(layers.lines[0][2], Eigen::Vector2d(11.001, 48.002));
  EXPECT_EQ(layers.lines[2][0], Eigen::Vector2d(13, 49));
  EXPECT_EQ(layers.lines[3], Polyline2{Eigen::Vector2d(14, 50)});
  ASSERT_TRUE(layers.crs);
  EXPECT_TRUE(layers.crs->is_geographic());
}

TEST_F(OgrFootprints, TracksWithoutALineAreNamed) {
  EXPECT_THROW(read_ogr_lines(folder_ / "absent.geojson"), IoError);
  EXPECT_THROW(read_ogr_lines(write("text.geojson", "no map")), FormatError);
  EXPECT_THROW(read_ogr_lines(write_features(feature("", square))), FormatError);
}

TEST_F(OgrFootprints, TheFootprintsOfGothenburg) {
  const char* given = std::getenv("PRIORMAP_SHARED_DATA");
  const fs::path shared = given ? fs::path(given) : fs::path(PRIORMAP_SOURCE_DIR) / "../shared/data";
  const fs::path file = shared / "overlap_gothenburg/gvc_footprints.shp";
  if (!fs::exists(file)) GTEST_SKIP() << "the real inputs are absent";
  const Layers layers = read(file, {});
  EXPECT_EQ(layers.footprints.size(), 119u);
  ASSERT_TRUE(layers.crs);
  EXPECT_TRUE(layers.crs->equivalent_to(Crs::parse("EPSG:3006")));
  double size = 0;
  for (const Footprint& footprint : layers.footprints)
    for (const Polygon2& polygon : normalize(footprint.rings, footprint.id, diagnostics_)) size += area(polygon);
  EXPECT_NEAR(size, 43000, 25000);
  EXPECT_EQ(diagnostics_.total(), 0u);
}

}  // namespace
}  // namespace priormap
