#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/sources/height_raster.hpp>
#include <priormap/sources/osm_footprints.hpp>
#include <priormap/sources/osm_streets.hpp>
#include <priormap/sources/osm_writer.hpp>
#include <priormap/sources/raster_writer.hpp>

namespace priormap {
namespace {

namespace fs = std::filesystem;

fs::path fresh(const std::string& name) {
  const fs::path path = fs::path(testing::TempDir()) / ("source_writers_" + name);
  fs::remove(path);
  return path;
}

OsmExtract two_houses() {
  OsmExtract extract;
  extract.areas.push_back({{{{11.50, 48.10}, {11.51, 48.10}, {11.51, 48.11}, {11.50, 48.11}}, {}}, {{"building", "yes"}, {"height", "7.5"}}});
  extract.areas.push_back({{{{11.52, 48.10}, {11.55, 48.10}, {11.55, 48.12}, {11.52, 48.12}},
                            {{{11.53, 48.105}, {11.53, 48.115}, {11.54, 48.115}, {11.54, 48.105}}}}, {{"building", "yes"}}});
  extract.lines.push_back({{{11.4, 48.0}, {11.45, 48.05}}, {{"highway", "residential"}, {"width", "6"}}});
  extract.lines.push_back({{{11.45, 48.05}, {11.5, 48.0}, {11.6, 48.0}}, {{"highway", "service"}, {"name", "Hof"}}});
  extract.lines.push_back({{{11.45, 48.05}, {11.5, 48.2}}, {{"highway", "footway"}}});
  extract.places.push_back({{11.47, 48.01}, {{"natural", "tree"}}});
  return extract;
}

TEST(OsmWriter, BuildingsReadBackFromBothFormats) {
  for (const char* name : {"town.osm.pbf", "town.osm"}) {
    const fs::path file = fresh(name);
    write_osm(file, two_houses());
    Diagnostics diagnostics;
    const auto footprints = read_osm_footprints({file}, 1, diagnostics);
    EXPECT_EQ(diagnostics.total(), 0u);
    ASSERT_EQ(footprints.size(), 2u) << name;
    const bool way_first = footprints[0].id == "way/1";
    const Footprint &plain = footprints[way_first ? 0 : 1], &with_hole = footprints[way_first ? 1 : 0];
    EXPECT_EQ(plain.attributes.height_m, 7.5);
    ASSERT_EQ(plain.rings.size(), 1u);
    EXPECT_NEAR(std::abs(signed_area(plain.rings[0])), 1e-4, 1e-9);
    EXPECT_EQ(with_hole.id, "relation/1");
    EXPECT_EQ(with_hole.rings.size(), 2u);
    EXPECT_FALSE(with_hole.attributes.height_m);
  }
}

TEST(OsmStreets, MeetAtSharedNodesAndLeaveFootwaysOut) {
  const fs::path file = fresh("streets.osm.pbf");
  write_osm(file, two_houses());
  const auto streets = read_osm_streets(file);
  ASSERT_EQ(streets.size(), 2u);
  EXPECT_EQ(streets[0].nodes.back(), streets[1].nodes.front());
  EXPECT_EQ(streets[0].width_m, 6);
  EXPECT_EQ(streets[1].name, "Hof");
  EXPECT_EQ(streets[1].width_m, 4.5);
  EXPECT_NEAR(streets[1].lon_lat[1].x(), 11.5, 1e-7);
  EXPECT_THROW(read_osm_streets("/nowhere/town.osm.pbf"), IoError);
}

TEST(OsmStreets, MayStandBeforeTheirNodesAndNodesInAnyOrder) {
  const fs::path file = fresh("unsorted.osm");
  std::ofstream(file) << "<?xml version='1.0'?><osm version='0.6'>"
                         "<way id='8' version='1'><nd ref='2'/><nd ref='1'/><tag k='highway' v='residential'/></way>"
                         "<node id='2' version='1' lat='48.2' lon='11.2'/><node id='1' version='1' lat='48.1' lon='11.1'/>"
                         "<way id='7' version='1'><nd ref='1'/><nd ref='2'/><tag k='highway' v='residential'/></way></osm>";
  const auto streets = read_osm_streets(file);
  ASSERT_EQ(streets.size(), 2u);
  EXPECT_EQ(streets[0].id, "way/7");
  EXPECT_NEAR((streets[0].lon_lat[1] - Eigen::Vector2d(11.2, 48.2)).norm(), 0, 1e-7);
  EXPECT_NEAR((streets[1].lon_lat[1] - Eigen::Vector2d(11.1, 48.1)).norm(), 0, 1e-7);
}

TEST(OsmStreets, MaySayThemselvesWhereTheirNodesLie) {
  const fs::path file = fresh("with_locations.osm");
  std::ofstream(file) << "<?xml version='1.0'?><osm version='0.6'><way id='7' version='1'><nd ref='1' lat='48.1' lon='11.1'/><nd ref='2' lat='48.2' lon='11.2'/>"
                         "<tag k='highway' v='residential'/></way></osm>";
  const auto streets = read_osm_streets(file);
  ASSERT_EQ(streets.size(), 1u);
  EXPECT_NEAR((streets[0].lon_lat[1] - Eigen::Vector2d(11.2, 48.2)).norm(), 0, 1e-7);
}

TEST(OsmWriter, SameExtractSameBytes) {
  const fs::path a = fresh("a.osm.pbf"), b = fresh("b.osm.pbf");
  write_osm(a, two_houses());
  write_osm(b, two_houses());
  EXPECT_EQ(sha256_file(a), sha256_file(b));
  EXPECT_THROW(write_osm("/nowhere/town.osm.pbf", two_houses()), IoError);
}

TEST(RasterWriter, HeightsReadBackWithTheirCrs) {
  HeightGrid grid;
  grid.west = 690000;
  grid.north = 5340010;
  grid.cell_size = 2;
  grid.columns = 4;
  grid.rows = 5;
  for (int i = 0; i < 20; ++i) grid.heights_m.push_back(500.25f + static_cast<float>(i));
  grid.heights_m[7] = NAN;
  const fs::path file = fresh("heights.tif");
  const Crs crs = Crs::parse("EPSG:25832+7837");
  write_geotiff(file, grid, crs);
  const HeightRaster raster = HeightRaster::open(file, std::nullopt, crs);
  EXPECT_TRUE(raster.source().equivalent_to(crs)) << raster.source().name();
  EXPECT_NEAR(*raster.at(grid.cell_centre(0, 0).x(), grid.cell_centre(0, 0).y()), 500.25, 1e-6);
  EXPECT_NEAR(*raster.at(grid.cell_centre(2, 3).x(), grid.cell_centre(2, 3).y()), 514.25, 1e-6);
  EXPECT_FALSE(raster.at(grid.cell_centre(3, 1).x(), grid.cell_centre(3, 1).y()));
  EXPECT_THROW(write_geotiff("/nowhere/heights.tif", grid, crs), IoError);
}

}  // namespace
}  // namespace priormap
