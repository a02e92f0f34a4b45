#include <priormap/geodesy/lon_lat_area.hpp>

#include <gtest/gtest.h>

#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/geodesy/transformer.hpp>

namespace priormap {
namespace {

const LonLatArea fiji{177, -21, -178, -12};

TEST(LonLatArea, MayCrossTheAntimeridian) {
  EXPECT_EQ(fiji.width_deg(), 5);
  EXPECT_EQ(fiji.middle().lon_deg, 179.5);
  EXPECT_EQ(fiji.degrees_outside({-15, 179.9, 0}), 0);
  EXPECT_EQ(fiji.degrees_outside({-15, -177, 0}), 1);
  EXPECT_EQ(fiji.degrees_outside({-15, 175, 0}), 2);
}

TEST(LonLatArea, UnitesTheShorterWayRoundTheEarth) {
  const LonLatArea west{170, -20, 175, -10}, east{-179, -15, -170, -5};
  for (const LonLatArea& both : {united(west, east), united(east, west)}) {
    EXPECT_EQ(both.west_deg, 170);
    EXPECT_EQ(both.east_deg, -170);
    EXPECT_EQ(both.south_deg, -20);
    EXPECT_EQ(both.north_deg, -5);
  }
  EXPECT_EQ(united({5, 47, 8, 50}, {10, 45, 15, 48}).width_deg(), 10);
  EXPECT_EQ(united(fiji, {178, -18, 179, -17}).width_deg(), 5) << "one holds the other";
  EXPECT_EQ(united({-180, 0, 10, 1}, {5, 0, 180, 1}).width_deg(), 360);
}

TEST(LonLatArea, OfARectangleInDegreesOrMetres) {
  const Crs lon_lat = Crs::parse("EPSG:4326"), zone_60 = Crs::parse("EPSG:32760");
  const LonLatArea munich = lon_lat_area({11.5, 48.1, 11.6, 48.2}, lon_lat).value();
  EXPECT_NEAR(munich.west_deg, 11.5, 1e-6);
  EXPECT_NEAR(munich.north_deg, 48.2, 1e-6);
  for (const Bounds2& across : {Bounds2{179.9, -17.1, 180.1, -17}, Bounds2{-180.1, -17.1, -179.9, -17}}) {
    const LonLatArea area = lon_lat_area(across, lon_lat).value();
    EXPECT_NEAR(area.west_deg, 179.9, 1e-6);
    EXPECT_NEAR(area.east_deg, -179.9, 1e-6);
  }
  const Eigen::Vector3d corner = Transformer(lon_lat, zone_60).forward({180, -17, 0});
  const LonLatArea projected = lon_lat_area({corner.x() - 1000, corner.y() - 1000, corner.x() + 1000, corner.y() + 1000}, zone_60).value();
  EXPECT_NEAR(projected.width_deg(), 2000 / (111320 * std::cos(17 * M_PI / 180)), 1e-3);
  EXPECT_GT(projected.west_deg, projected.east_deg);
}

}  // namespace
}  // namespace priormap
