#include <priormap/geodesy/transformer.hpp>

#include <gtest/gtest.h>

#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/undulation.hpp>

using Eigen::Vector3d;
using priormap::Crs;
using priormap::CrsError;
using priormap::LonLatArea;
using priormap::Transformer;

namespace {

Transformer transformer(const char* source, const char* target) { return {Crs::parse(source), Crs::parse(target)}; }

std::string refusal(const char* source, const char* target) {
  try {
    transformer(source, target);
    return "";
  } catch (const CrsError& error) {
    return error.what();
  }
}

TEST(TransformerTest, EllipsoidalToEgm96HeightsNearMunich) {
  const Transformer t = transformer("EPSG:4979", "EPSG:25832+5773");
  const Vector3d p = t.forward(Vector3d(11.57, 48.15, 500));
  EXPECT_NEAR(p.z(), 454.456, 0.001);
  EXPECT_EQ(t.operation().grids, std::vector<std::string>{"us_nga_egm96_15.tif"});
  EXPECT_NEAR(t.inverse(p).z(), 500, 1e-6);
  EXPECT_NEAR(priormap::egm96_undulation_m(11.57, 48.15), 500 - 454.456, 0.001);
}

TEST(TransformerTest, MissingGeoidGridIsRefusedByName) {
  EXPECT_NE(refusal("EPSG:4979", "EPSG:25832+7837").find("GCG2016"), std::string::npos) << refusal("EPSG:4979", "EPSG:25832+7837");
  EXPECT_NE(refusal("EPSG:27700+5701", "EPSG:32630+5773").find("OSGM15"), std::string::npos) << refusal("EPSG:27700+5701", "EPSG:32630+5773");
}

TEST(TransformerTest, UndeclaredHeightsNeverBecomeDeclaredOnes) {
  for (const char* source : {"EPSG:4326", "EPSG:25832", "EPSG:27700"})
    for (const char* target : {"EPSG:25832+7837", "EPSG:25832+5773", "EPSG:32630+5773", "EPSG:4979", "EPSG:27700+5701", "EPSG:4937"})
      EXPECT_NE(refusal(source, target).find("undeclared"), std::string::npos) << source << " to " << target;
}

TEST(TransformerTest, SameVerticalDatumPassesHeightsExactly) {
  const Vector3d p = transformer("EPSG:25833+7837", "EPSG:25832+7837").forward(Vector3d(400000, 5800000, 123.456));
  EXPECT_EQ(p.z(), 123.456);
  EXPECT_GT(p.x(), 700000);
  EXPECT_EQ(transformer("EPSG:31467+7837", "EPSG:25832+7837").forward(Vector3d(3500000, 5400000, 1.5)).z(), 1.5);
}

TEST(TransformerTest, HeightsStayAsDeclaredWhereTheTargetHasNone) {
  EXPECT_EQ(transformer("EPSG:25832+7837", "EPSG:4326").forward(Vector3d(691000, 5336000, 520.1)).z(), 520.1);
  EXPECT_EQ(transformer("EPSG:27700", "EPSG:4326").forward(Vector3d(532000, 181000, 17.5)).z(), 17.5);
}

TEST(TransformerTest, UsFeetBecomeMetres) {
  const Vector3d p = transformer("EPSG:2263+6360", "EPSG:26918+5703").forward(Vector3d(1000000, 230000, 100));
  EXPECT_NEAR(p.z(), 100 * 1200.0 / 3937, 1e-9);
  const Vector3d q = transformer("EPSG:26918+5703", "EPSG:2263+6360").forward(p);
  EXPECT_NEAR((q - Vector3d(1000000, 230000, 100)).norm(), 0, 1e-4);
}

TEST(TransformerTest, VerticalSystemsAloneAreRefused) { EXPECT_NE(refusal("EPSG:7837", "EPSG:25832"), ""); }

TEST(TransformerTest, IdentityIsExact) {
  const Transformer t = transformer("EPSG:25832+7837", "urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH");
  EXPECT_TRUE(t.is_identity());
  const Vector3d p(691234.567891234, 5336000.123456789, 1.0 / 3);
  EXPECT_EQ(t.forward(p), p);
  EXPECT_TRUE(transformer("EPSG:4326", "OGC:CRS84").is_identity());
}

TEST(TransformerTest, AccuracyOfTheFallbackIsRecordedWithTheBetterGrid) {
  const Transformer t = transformer("EPSG:27700", "EPSG:4326");
  ASSERT_TRUE(t.operation().accuracy_m.has_value());
  EXPECT_GE(*t.operation().accuracy_m, 1);
  EXPECT_TRUE(t.operation().grids.empty());
  ASSERT_FALSE(t.operation().better_grids.empty());
  EXPECT_NE(t.operation().better_grids.front().find("OSTN15"), std::string::npos);
  // Caister water tower, the worked example of Ordnance Survey's guide to coordinate systems.
  const Vector3d p = t.forward(Vector3d(651409.792, 313177.448, 0));
  EXPECT_NEAR(p.x(), 1 + 42 / 60.0 + 57.79 / 3600, 5e-5);
  EXPECT_NEAR(p.y(), 52 + 39 / 60.0 + 28.72 / 3600, 5e-5);
}

TEST(TransformerTest, NullTransformationOfEtrs89IsNotBallpark) {
  const Transformer t = transformer("EPSG:4326", "EPSG:25832");
  EXPECT_NE(t.operation().name.find("ETRS89 to WGS 84 (1)"), std::string::npos) << t.operation().name;
  EXPECT_EQ(t.operation().accuracy_m, 1.0);
}

TEST(TransformerTest, TheAreaChoosesTheOperationWhateverWasAskedBefore) {
  const std::vector<std::optional<LonLatArea>> areas = {LonLatArea{10, 48, 10.1, 48.1}, LonLatArea{-8, 38, -7.9, 38.1}, LonLatArea{5, 60, 5.1, 60.1}, std::nullopt};
  const auto names = [](const std::vector<std::optional<LonLatArea>>& asked) {
    std::vector<std::string> found;
    std::thread([&] {   // each thread begins with nothing known
      for (int round = 0; round < 2; ++round)
        for (const std::optional<LonLatArea>& area : asked) found.push_back(Transformer(Crs::parse("EPSG:4230"), Crs::parse("EPSG:4326"), area).operation().name);
    }).join();
    return found;
  };
  const std::vector<std::string> forth = names(areas);
  EXPECT_EQ(std::set<std::string>(forth.begin(), forth.end()).size(), areas.size());
  EXPECT_TRUE(std::equal(forth.begin(), forth.begin() + 4, forth.begin() + 4));
  std::vector<std::string> back = names({areas.rbegin(), areas.rend()});
  std::ranges::reverse(back);
  EXPECT_EQ(back, forth);
}

TEST(TransformerTest, UnknownDatumHasNoOperation) {
  EXPECT_NE(refusal("+proj=utm +zone=32 +ellps=bessel", "EPSG:25832").find("no exact transformation is known"), std::string::npos);
}

TEST(TransformerTest, PointsOutsideBecomeNaN) {
  std::vector<Vector3d> points = {{11.57, 48.15, 0}, {11.57, 95, 0}, {std::nan(""), 48, 0}, {11.57, 48.15, 0}};
  transformer("EPSG:4326", "EPSG:25832").forward(points);
  EXPECT_TRUE(points[0].allFinite());
  EXPECT_TRUE(points[1].array().isNaN().all());
  EXPECT_TRUE(points[2].array().isNaN().all());
  EXPECT_EQ(points[0], points[3]);
}

TEST(TransformerTest, CopiesGiveTheSameBitsInOtherThreads) {
  const Transformer original = transformer("EPSG:4326", "EPSG:25832");
  const Vector3d p(11.57, 48.15, 3);
  const Vector3d expected = original.forward(p);
  Transformer copy = original;
  Vector3d result;
  std::thread([&result, copy, p] { result = copy.forward(p); }).join();
  EXPECT_EQ(result, expected);
  copy = transformer("EPSG:4326", "EPSG:32632");
  EXPECT_EQ(copy.target().name(), "EPSG:32632");
}

// GeographicLib's transverse Mercator is an implementation of its own (Karney 2011, exact to nanometres).
TEST(TransformerTest, UtmAgreesWithGeographicLibWorldwide) {
  double worst_m = 0;
  for (int zone = 1; zone <= 60; zone += 1)
    for (const bool north : {true, false}) {
      const Transformer t(Crs::parse("EPSG:4326"), Crs::parse("EPSG:" + std::to_string((north ? 32600 : 32700) + zone)));
      for (double lat = 0.5; lat < 84; lat += 8.35)
        for (double from_meridian = -3; from_meridian <= 3; from_meridian += 1.5) {
          const double lon_deg = zone * 6 - 183 + from_meridian, lat_deg = north ? lat : -std::min(lat, 79.9);
          double x = 0, y = 0, convergence = 0, scale = 0;
          int found_zone = 0;
          bool found_north = false;
          GeographicLib::UTMUPS::Forward(lat_deg, lon_deg, found_zone, found_north, x, y, convergence, scale, zone);
          const Vector3d p = t.forward(Vector3d(lon_deg, lat_deg, 0));
          worst_m = std::max(worst_m, std::hypot(p.x() - x, p.y() - y));
          const Vector3d back = t.inverse(p);
          worst_m = std::max(worst_m, 111e3 * std::hypot(back.x() - lon_deg, back.y() - lat_deg));
        }
    }
  EXPECT_LT(worst_m, 1e-4);
}

// North-first by its authority (x north, y east): east comes first here all the same.
TEST(TransformerTest, GaussKruegerComesEastFirst) {
  const Transformer t = transformer("EPSG:4314", "EPSG:31467");
  const GeographicLib::TransverseMercator bessel(6377397.155, 1 / 299.1528128, 1);
  double x = 0, y = 0;
  bessel.Forward(9, 48.7, 9.2, x, y);
  const Vector3d p = t.forward(Vector3d(9.2, 48.7, 0));
  EXPECT_NEAR(p.x(), x + 3500000, 1e-4);
  EXPECT_NEAR(p.y(), y, 1e-4);
}

struct Place {
  const char* crs;
  double x, y;               // as published or as the shared data has it
  double lon_deg, lat_deg;   // within tolerance
};

class NationalGridTest : public ::testing::TestWithParam<Place> {};

TEST_P(NationalGridTest, GoesToWgs84AndBack) {
  const Place& place = GetParam();
  const Transformer t = transformer(place.crs, "EPSG:4326");
  const Vector3d p = t.forward(Vector3d(place.x, place.y, 12));
  EXPECT_NEAR(p.x(), place.lon_deg, 2e-3) << place.crs;
  EXPECT_NEAR(p.y(), place.lat_deg, 2e-3) << place.crs;
  EXPECT_EQ(p.z(), 12);
  EXPECT_TRUE(t.operation().accuracy_m.has_value());
  const Vector3d back = t.inverse(p);
  // Datum shifts of heights taken as 0 on either side: the way back closes to the shift's tilt times its height.
  EXPECT_NEAR(back.x(), place.x, 2e-3);
  EXPECT_NEAR(back.y(), place.y, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Places, NationalGridTest,
                         ::testing::Values(Place{"EPSG:31256", 2922, 341094, 16.373, 48.2085},     // Vienna, Stephansdom
                                           Place{"EPSG:2154", 652469, 6862035, 2.3522, 48.8566},    // Paris
                                           Place{"EPSG:28992", 155000, 463000, 5.3876, 52.1552},    // Amersfoort, its origin
                                           Place{"EPSG:21781", 600000, 200000, 7.4386, 46.9511},    // Bern, its origin
                                           Place{"EPSG:2056", 2600000, 1200000, 7.4386, 46.9511},
                                           Place{"EPSG:3006", 500000, 6400000, 15, 57.7423},        // on its central meridian
                                           Place{"EPSG:3007", 150000, 6397000, 12, 57.6922},
                                           Place{"EPSG:26918", 589000, 4518000, -73.945, 40.808},   // Harlem
                                           Place{"EPSG:2992", 637000, 851000, -123.07, 44.056}));   // Autzen stadium, feet

}  // namespace
