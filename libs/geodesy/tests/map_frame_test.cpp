#include <priormap/geodesy/map_frame.hpp>

#include <gtest/gtest.h>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/undulation.hpp>

using Eigen::Vector3d;
using priormap::Crs;
using priormap::CrsError;
using priormap::MapFrame;
using priormap::Transformer;

namespace {

constexpr double deg = std::numbers::pi / 180;

MapFrame karlsruhe(const char* crs = "EPSG:25832+7837") {
  const Crs prior = Crs::parse(crs);
  Vector3d p = Transformer(prior.geographic_base(), prior.horizontal()).forward(Vector3d(8.39036610004500, 48.98254523586602, 116.38));
  return MapFrame::at(prior, p);
}

TEST(MapFrameTest, OriginIsZeroAndHeightIsKept) {
  const MapFrame frame = karlsruhe();
  const Vector3d origin = frame.to_projected(Vector3d(0, 0, 116.38));
  EXPECT_NEAR(frame.origin().lat_deg, 48.98254523586602, 1e-11);
  EXPECT_NEAR(frame.origin().lon_deg, 8.39036610004500, 1e-11);
  const Vector3d zero = frame.to_map(origin);
  EXPECT_LT(zero.head<2>().norm(), 1e-6);
  EXPECT_EQ(zero.z(), 116.38);
}

// The scale counts from the ellipsoid: the prior's height and the geoid's 48 m above the ellipsoid.
TEST(MapFrameTest, ScaleRaisesTheProjectionToTheFirstPose) {
  const MapFrame frame = karlsruhe();
  const double undulation_m = priormap::egm96_undulation_m(8.39036610004500, 48.98254523586602);
  EXPECT_NEAR(undulation_m, 48, 2);
  EXPECT_NEAR(frame.origin().height_m, 116.38 + undulation_m, 1e-9);
  EXPECT_NEAR(frame.scale_factor(), 1 + (116.38 + undulation_m) / 6383e3, 1e-8);
  EXPECT_NEAR(karlsruhe("EPSG:25832").scale_factor(), frame.scale_factor(), 1e-12);
}

// Ground truth: Karney's geodesics on GRS 80, raised to the first pose's height.
TEST(MapFrameTest, DistancesAreTrueWithin1ppmOver5km) {
  const MapFrame frame = karlsruhe();
  const GeographicLib::Geodesic grs80(6378137, 1 / 298.257222101);
  const double raised = frame.scale_factor();
  const Transformer to_base(frame.crs(), frame.projected().geographic_base());
  for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 15) {
    const Vector3d a(2500 * std::sin(azimuth_deg * deg), 2500 * std::cos(azimuth_deg * deg), 0), b = -a;
    const Vector3d a_deg = to_base.forward(a), b_deg = to_base.forward(b), o_deg = to_base.forward(Vector3d(0, 0, 0));
    double s = 0;
    grs80.Inverse(a_deg.y(), a_deg.x(), b_deg.y(), b_deg.x(), s);
    EXPECT_NEAR(s * raised / 5000, 1, 1e-6);
    const Vector3d far_deg = to_base.forward(Vector3d(2 * a));
    grs80.Inverse(o_deg.y(), o_deg.x(), far_deg.y(), far_deg.x(), s);
    EXPECT_NEAR(s * raised / 5000, 1, 1e-6);
  }
}

TEST(MapFrameTest, IsTheTransverseMercatorThatGeographicLibComputes) {
  const MapFrame frame = karlsruhe();
  const GeographicLib::TransverseMercator oracle(6378137, 1 / 298.257222101, frame.scale_factor());
  double x = 0, y = 0, x_0 = 0, y_0 = 0;
  oracle.Forward(frame.origin().lon_deg, frame.origin().lat_deg, frame.origin().lon_deg, x_0, y_0);
  oracle.Forward(frame.origin().lon_deg, 49.0, 8.45, x, y);
  const Transformer to_base(frame.crs(), frame.projected().geographic_base());
  const Vector3d p = to_base.inverse(Vector3d(8.45, 49.0, 0));
  EXPECT_NEAR(p.x(), x - x_0, 1e-4);
  EXPECT_NEAR(p.y(), y - y_0, 1e-4);
}

TEST(MapFrameTest, RoundTripClosesFarFromTheOrigin) {
  const MapFrame frame = karlsruhe();
  std::vector<Vector3d> points = {{0, 0, 1}, {30000, -20000, 2}, {-5000.25, 12345.5, -3}};
  const std::vector<Vector3d> expected = points;
  frame.to_projected(points);
  frame.to_map(points);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((points[i] - expected[i]).norm(), 1e-6);
}

// UTM at Karlsruhe is 38 cm a kilometre short of true distances; east of 6 degrees from its meridian grid north is turned.
TEST(MapFrameTest, GridScaleAndRotationAgreeWithGeographicLib) {
  const MapFrame frame = karlsruhe();
  const Vector3d p_map(3000, 2000, 110);
  const Vector3d lon_lat = Transformer(frame.crs(), frame.projected().geographic_base()).forward(p_map);
  double x = 0, y = 0, utm_convergence_deg = 0, utm_scale = 0, map_convergence_deg = 0, map_scale = 0;
  GeographicLib::TransverseMercator(6378137, 1 / 298.257222101, 0.9996)
      .Forward(9, lon_lat.y(), lon_lat.x(), x, y, utm_convergence_deg, utm_scale);
  GeographicLib::TransverseMercator(6378137, 1 / 298.257222101, frame.scale_factor())
      .Forward(frame.origin().lon_deg, lon_lat.y(), lon_lat.x(), x, y, map_convergence_deg, map_scale);
  // GeographicLib: convergence is the bearing of grid north, clockwise from true north.
  EXPECT_NEAR(frame.grid_rotation(p_map), (utm_convergence_deg - map_convergence_deg) * deg, 1e-9);
  EXPECT_NEAR(frame.grid_scale(p_map), utm_scale / map_scale, 1e-9);
  EXPECT_NEAR(frame.convergence(p_map), map_convergence_deg * deg, 1e-8);
  EXPECT_NEAR(frame.grid_scale(Vector3d(0, 0, 0)), (1 - 0.00038) / frame.scale_factor(), 1e-5);
  EXPECT_NEAR(frame.convergence(Vector3d(0, 0, 0)), 0, 1e-9);
}

// What a sensor sees does not turn when its pose is told in another frame.
TEST(MapFrameTest, PosesTurnWithTheGrid) {
  const MapFrame frame = karlsruhe();
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  T_map_sensor.linear() = (Eigen::AngleAxisd(0.7, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.1, Vector3d::UnitX())).toRotationMatrix();
  T_map_sensor.translation() = Vector3d(1500, -800, 112);
  const Eigen::Isometry3d T_projected_sensor = frame.pose_to_projected(T_map_sensor);
  const Vector3d p_sensor(20, 0, 0);
  const Vector3d seen = frame.to_projected(Vector3d(T_map_sensor * p_sensor));
  EXPECT_LT((T_projected_sensor * p_sensor - seen).norm(), 20 * 4.5e-4);
  EXPECT_LT(((T_projected_sensor * p_sensor - T_projected_sensor.translation()).normalized() -
             (seen - T_projected_sensor.translation()).normalized()).norm(), 1e-4);
  EXPECT_TRUE(frame.pose_to_map(T_projected_sensor).isApprox(T_map_sensor, 1e-9));
}

TEST(MapFrameTest, LonLatIsWgs84WhateverTheDatum) {
  const Crs austrian = Crs::parse("EPSG:31256");
  const Vector3d origin = Transformer(Crs::parse("EPSG:4326"), austrian).forward(Vector3d(16.373, 48.2085, 0));
  const MapFrame frame = MapFrame::at(austrian, Vector3d(origin.x(), origin.y(), 170));
  const Vector3d lon_lat = frame.to_lon_lat(Vector3d(0, 0, 170));
  EXPECT_NEAR(lon_lat.x(), 16.373, 1e-7);
  EXPECT_NEAR(lon_lat.y(), 48.2085, 1e-7);
  EXPECT_EQ(lon_lat.z(), 170);
}

TEST(MapFrameTest, FeetOfThePriorBecomeMetres) {
  const Crs new_york = Crs::parse("EPSG:2263+6360");
  const MapFrame frame = MapFrame::at(new_york, Vector3d(1000000, 230000, 100));
  const double foot_m = 1200.0 / 3937;
  const Vector3d p = frame.to_map(Vector3d(1000100, 230000, 110));
  EXPECT_NEAR(p.norm(), std::hypot(100 * foot_m, 110 * foot_m), 0.01);
  EXPECT_NEAR(p.z(), 110 * foot_m, 1e-9);
  EXPECT_NEAR(frame.grid_scale(Vector3d(0, 0, 0)), 1, 2e-4);
  EXPECT_NEAR(frame.to_projected(p).z(), 110, 1e-9);
}

TEST(MapFrameTest, UnknownDatumMapsButHasNoLonLat) {
  const MapFrame frame = MapFrame::at(Crs::parse("+proj=utm +zone=32 +ellps=bessel"), Vector3d(500000, 5400000, 0));
  EXPECT_LT(frame.to_map(Vector3d(500000, 5400000, 0)).norm(), 1e-6);
  EXPECT_THROW(frame.to_lon_lat(Vector3d(0, 0, 0)), CrsError);
}

TEST(MapFrameTest, LocalFrameIsTheCloudsOwn) {
  const MapFrame frame = MapFrame::local();
  EXPECT_FALSE(frame.georeferenced());
  EXPECT_EQ(frame.to_map(Vector3d(1, 2, 3)), Vector3d(1, 2, 3));
  EXPECT_THROW(frame.projected(), CrsError);
  EXPECT_THROW(frame.grid_rotation(Vector3d(0, 0, 0)), CrsError);
}

TEST(MapFrameTest, GeographicPriorsAndPlacesOutsideAreRefused) {
  EXPECT_THROW(MapFrame::at(Crs::parse("EPSG:4326"), Vector3d(8, 49, 0)), CrsError);
  EXPECT_THROW(MapFrame::at(Crs::parse("EPSG:25832"), Vector3d(1e12, 5e6, 0)), CrsError);
}

TEST(MapFrameTest, CopiesAreIndependent) {
  const MapFrame frame = karlsruhe();
  const MapFrame copy = frame;
  EXPECT_EQ(copy.to_projected(Vector3d(10, 20, 30)), frame.to_projected(Vector3d(10, 20, 30)));
}

}  // namespace
