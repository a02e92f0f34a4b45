#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/option_crs.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <priormap/core/error.hpp>

using priormap::LonLatArea;
using priormap::Crs;
using priormap::CrsError;
using priormap::horizontal_option_crs;
using priormap::option_crs;
using priormap::UsageError;
using priormap::vertical_option_crs;

namespace {

struct Form {
  const char* text;
  const char* name;
};

class CrsFormTest : public ::testing::TestWithParam<Form> {};

TEST_P(CrsFormTest, NamesTheSameSystem) { EXPECT_EQ(Crs::parse(GetParam().text).name(), GetParam().name); }

INSTANTIATE_TEST_SUITE_P(
    AllForms, CrsFormTest,
    ::testing::Values(
        Form{"EPSG:25832", "EPSG:25832"}, Form{" epsg:25832\n", "EPSG:25832"}, Form{"EPSG::25832", "EPSG:25832"},
        Form{"EPSG:25832+7837", "EPSG:25832+7837"}, Form{"EPSG:25832+EPSG:7837", "EPSG:25832+7837"},
        Form{"urn:ogc:def:crs:EPSG::25832", "EPSG:25832"}, Form{"urn:ogc:def:crs:EPSG:6.12:25832", "EPSG:25832"},
        Form{"urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837", "EPSG:25832+7837"},
        Form{"urn:ogc:def:crs,crs:EPSG:6.12:3068,crs:EPSG:6.12:5783", "EPSG:3068+5783"},
        Form{"http://www.opengis.net/def/crs/EPSG/0/25832", "EPSG:25832"},
        Form{"https://www.opengis.net/def/crs/EPSG/0/7415", "EPSG:28992+5709"},
        Form{"http://www.opengis.net/def/crs-compound?1=http://www.opengis.net/def/crs/EPSG/0/25832"
             "&2=http://www.opengis.net/def/crs/EPSG/0/7837",
             "EPSG:25832+7837"},
        Form{"http://www.opengis.net/gml/srs/epsg.xml#25832", "EPSG:25832"}, Form{"urn:EPSG:geographicCRS:4326", "EPSG:4326"},
        Form{"urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH", "EPSG:25832+7837"}, Form{"urn:adv:crs:ETRS89_UTM33", "EPSG:25833"},
        Form{"urn:adv:crs:ETRS89_UTM33*DE_DHHN92_NH", "EPSG:25833+5783"},
        Form{"urn:adv:crs:DE_DHDN_3GK3_BW100*DE_DHHN12_NOH", "EPSG:31467+7699"},
        Form{"urn:adv:crs:DE_DHHN2016_NH", "EPSG:7837"}, Form{"+init=epsg:31467", "EPSG:31467"}, Form{"EPSG:4979", "EPSG:4979"},
        Form{"urn:x-ogc:def:crs:EPSG:25832", "EPSG:25832"}, Form{"urn:x-ogc:def:crs:EPSG:6.11:4326", "EPSG:4326"}, Form{"CRS:84", "OGC:CRS84"},
        Form{"urn:ogc:def:crs:OGC:1.3:CRS84", "OGC:CRS84"}, Form{"EPSG:7837", "EPSG:7837"}));

TEST(CrsTest, WktAndProjJsonKeepTheCode) {
  const Crs crs = Crs::parse("EPSG:25832+7837");
  EXPECT_EQ(Crs::parse(crs.wkt1()).name(), "EPSG:25832+7837");
  EXPECT_EQ(Crs::parse(crs.wkt2()).name(), "EPSG:25832+7837");
  EXPECT_EQ(Crs::parse(R"({"type":"GeographicCRS","name":"WGS 84","datum":{"type":"GeodeticReferenceFrame","name":"World Geodetic System 1984","ellipsoid":{"name":"WGS 84","semi_major_axis":6378137,"inverse_flattening":298.257223563}},"coordinate_system":{"subtype":"ellipsoidal","axis":[{"name":"Geodetic latitude","abbreviation":"Lat","direction":"north","unit":"degree"},{"name":"Geodetic longitude","abbreviation":"Lon","direction":"east","unit":"degree"}]},"id":{"authority":"EPSG","code":4326}})").name(),
            "EPSG:4326");
}

TEST(CrsTest, EsriWktWithoutCodesIsIdentified) {
  EXPECT_EQ(Crs::parse("PROJCS[\"ETRS_1989_UTM_Zone_32N\",GEOGCS[\"GCS_ETRS_1989\",DATUM[\"D_ETRS_1989\",SPHEROID[\"GRS_1980\","
                       "6378137.0,298.257222101]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],"
                       "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],PARAMETER[\"False_Northing\",0.0],"
                       "PARAMETER[\"Central_Meridian\",9.0],PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],"
                       "UNIT[\"Meter\",1.0]]")
                .name(),
            "EPSG:25832");
}

// A code that contradicts the parameters beside it must not win.
TEST(CrsTest, WrongCodeInWktIsNotBelieved) {
  std::string wkt = Crs::parse("EPSG:25832").wkt1();
  const std::string meridian = "\"central_meridian\",9";
  wkt.replace(wkt.find(meridian), meridian.size(), "\"central_meridian\",10");
  const Crs crs = Crs::parse(wkt);
  EXPECT_EQ(crs.name().substr(0, 7), "PROJCRS");
  EXPECT_EQ(crs.with_vertical(Crs::parse("EPSG:7837")).name().substr(0, 11), "COMPOUNDCRS");
}

TEST(CrsTest, ProjStringsWithAndWithoutType) {
  const Crs typed = Crs::parse("+proj=utm +zone=32 +datum=WGS84 +type=crs"), bare = Crs::parse("+proj=utm +zone=32 +datum=WGS84");
  EXPECT_EQ(typed.name(), bare.name());
  EXPECT_TRUE(bare.is_projected());
  EXPECT_FALSE(bare.has_vertical());
}

TEST(CrsTest, NameParsesToTheSameSystem) {
  for (const char* text : {"EPSG:25832+7837", "EPSG:4979", "EPSG:2154", "+proj=tmerc +lat_0=48 +lon_0=11 +ellps=GRS80",
                           "+proj=utm +zone=32 +ellps=intl +towgs84=-87,-98,-121,0,0,0,0", "ESRI:102100", "IGNF:LAMB93"}) {
    const Crs crs = Crs::parse(text);
    const Crs again = Crs::parse(crs.name());
    EXPECT_EQ(Crs::parse(again.name()).name(), again.name());
    EXPECT_TRUE(again.equivalent_to(crs));
  }
}

TEST(CrsTest, UnknownTextsAreClearErrors) {
  for (const char* text : {"", "CH1903", "WGS 84", "EPSG:999999", "25832", "EPSG:25832+25833", "EPSG:4978", "EPSG:", "nonsense[",
                           "urn:adv:crs:ETRS89_UTM99", "urn:adv:crs:DE_XY", "http://example.com/crs", "EPSG:25832+",
                           "LOCAL_CS[\"x\",UNIT[\"metre\",1]]", "{\"type\":1}", "+proj=nonsense"}) {
    try {
      Crs::parse(text);
      ADD_FAILURE() << text;
    } catch (const CrsError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  try {
    Crs::parse("CH1903");
  } catch (const CrsError& error) {
    EXPECT_NE(std::string(error.what()).find("'CH1903'"), std::string::npos);
  }
}

// Krovak south-west: PROJ would hand over southing and westing as if they were east and north.
TEST(CrsTest, SouthWestAxesAreRefused) { EXPECT_THROW(Crs::parse("EPSG:5513"), CrsError); }

TEST(CrsTest, KnowsItsKindAndAxes) {
  EXPECT_TRUE(Crs::parse("EPSG:4326").is_geographic());
  EXPECT_TRUE(Crs::parse("EPSG:4326").authority_north_first());
  EXPECT_FALSE(Crs::parse("OGC:CRS84").authority_north_first());
  EXPECT_TRUE(Crs::parse("EPSG:31467").authority_north_first());
  EXPECT_FALSE(Crs::parse("EPSG:25832").authority_north_first());
  EXPECT_TRUE(Crs::parse("EPSG:25832").is_projected());
  EXPECT_FALSE(Crs::parse("EPSG:4326").has_vertical());
  EXPECT_TRUE(Crs::parse("EPSG:4979").has_vertical());
  EXPECT_FALSE(Crs::parse("EPSG:4979").vertical().has_value());
  EXPECT_TRUE(Crs::parse("EPSG:7837").is_vertical());
  EXPECT_EQ(Crs::parse("EPSG:25832+7837").human_name(), "ETRS89 / UTM zone 32N + DHHN2016 height");
}

TEST(CrsTest, UnitsInMetres) {
  EXPECT_EQ(Crs::parse("EPSG:25832+7837").vertical_unit_m(), 1);
  EXPECT_NEAR(Crs::parse("EPSG:2992").horizontal_unit_m(), 0.3048, 1e-12);            // Oregon, international foot
  EXPECT_NEAR(Crs::parse("EPSG:2263").horizontal_unit_m(), 1200.0 / 3937, 1e-12);     // New York, US survey foot
  EXPECT_NEAR(Crs::parse("EPSG:2263+6360").vertical_unit_m(), 1200.0 / 3937, 1e-12);  // NAVD88 height (ftUS)
  EXPECT_EQ(Crs::parse("EPSG:4326").horizontal_unit_m(), 1);
}

TEST(CrsTest, TakesApartAndPutsTogether) {
  const Crs compound = Crs::parse("EPSG:25832+7837");
  EXPECT_EQ(compound.horizontal().name(), "EPSG:25832");
  EXPECT_EQ(compound.vertical()->name(), "EPSG:7837");
  EXPECT_EQ(compound.geographic_base().name(), "EPSG:4258");
  EXPECT_EQ(compound.with_vertical(Crs::parse("EPSG:5783")).name(), "EPSG:25832+5783");
  EXPECT_EQ(Crs::parse("EPSG:25833").with_vertical(compound).name(), "EPSG:25833+7837");
  EXPECT_EQ(Crs::parse("EPSG:4979").horizontal().name(), "EPSG:4326");
  EXPECT_THROW(compound.with_vertical(Crs::parse("EPSG:25832")), CrsError);
  EXPECT_THROW(Crs::parse("EPSG:7837").horizontal(), CrsError);
}

TEST(CrsTest, EquivalenceIgnoresSpellingButNotMeaning) {
  EXPECT_TRUE(Crs::parse("EPSG:4326").equivalent_to(Crs::parse("OGC:CRS84")));
  EXPECT_TRUE(Crs::parse("EPSG:7415").equivalent_to(Crs::parse("EPSG:28992+5709")));
  EXPECT_FALSE(Crs::parse("EPSG:25832").equivalent_to(Crs::parse("EPSG:32632")));
  EXPECT_FALSE(Crs::parse("EPSG:25832").equivalent_to(Crs::parse("EPSG:25832+7837")));
  EXPECT_FALSE(Crs::parse("EPSG:25832+5783").equivalent_to(Crs::parse("EPSG:25832+7837")));
  EXPECT_TRUE(Crs::parse("EPSG:5703").same_vertical_datum(Crs::parse("EPSG:26918+6360")));
  EXPECT_FALSE(Crs::parse("EPSG:5783").same_vertical_datum(Crs::parse("EPSG:7837")));
}

TEST(CrsTest, UtmZonesWithTheExceptionsOfNorwayAndSvalbard) {
  EXPECT_EQ(Crs::utm_zone(11.57, 48.15).name(), "EPSG:32632");
  EXPECT_EQ(Crs::utm_zone(11.57, 48.15, true).name(), "EPSG:25832");
  EXPECT_EQ(Crs::utm_zone(5.3, 60.4, true).name(), "EPSG:25832");   // Bergen
  EXPECT_EQ(Crs::utm_zone(15.6, 78.2).name(), "EPSG:32633");        // Longyearbyen
  EXPECT_EQ(Crs::utm_zone(-73.9, 40.8, true).name(), "EPSG:32618");
  EXPECT_EQ(Crs::utm_zone(151.2, -33.9).name(), "EPSG:32756");
  EXPECT_EQ(Crs::utm_zone(180, 10).name(), "EPSG:32601");
  EXPECT_THROW(Crs::utm_zone(0, 88), CrsError);
  EXPECT_THROW(Crs::utm_zone(0, 91), CrsError);
  EXPECT_THROW(Crs::utm_zone(std::nan(""), 0), CrsError);
}

TEST(CrsTest, KnowsWhereItIsMeantToBeUsed) {
  const LonLatArea utm = Crs::parse("EPSG:25832+7837").area_of_use().value();
  EXPECT_NEAR(utm.west_deg, 6, 0.02);
  EXPECT_NEAR(utm.east_deg, 12, 0.02);
  EXPECT_EQ(utm.degrees_outside({48.1, 11.5, 0}), 0);
  EXPECT_NEAR(utm.degrees_outside({48.1, 13.5, 0}), 1.5, 0.02);
  EXPECT_NEAR(utm.degrees_outside({48.1, 5, 0}), 1, 0.02);
  EXPECT_NEAR(utm.degrees_outside({30, 13, 0}), 8.8, 0.1);
  EXPECT_FALSE(Crs::parse("+proj=tmerc +lon_0=9").area_of_use());
}

TEST(CrsTest, LengthsAreDistortedAsTheProjectionSays) {
  const Crs utm = Crs::parse("EPSG:25832");
  EXPECT_NEAR(utm.length_distortion({48, 9, 0}), 0.0004, 1e-7) << "by definition on the central meridian";
  EXPECT_NEAR(Crs::parse("EPSG:31468").length_distortion({48, 12, 0}), 0, 1e-7) << "northing first, true on its meridian";
  // On the sphere k = k0 / sqrt(1 - (cos(lat) sin(dlon))^2) (Snyder 1987, 8-4).
  const double across = std::cos(60 * M_PI / 180) * std::sin(20 * M_PI / 180);
  EXPECT_NEAR(utm.length_distortion({60, 29, 0}), 0.9996 / std::sqrt(1 - across * across) - 1, 2e-4);
  EXPECT_NEAR(Crs::parse("EPSG:3857").length_distortion({60, 10, 0}), 1, 0.01) << "Web Mercator doubles lengths at 60 degrees";
  for (const char* other_meridian : {"EPSG:27572", "EPSG:27561"})
    EXPECT_LT(Crs::parse(other_meridian).length_distortion({48.85, 2.34, 0}), 1e-3) << other_meridian << ": grads from Paris";
  EXPECT_LT(Crs::parse("EPSG:31292").length_distortion({48.2, 13.3, 0}), 1e-3) << "degrees from Ferro, northing first";
  EXPECT_LT(Crs::parse("EPSG:2263").length_distortion({40.7, -74, 0}), 1e-3) << "feet";
  EXPECT_EQ(utm.length_distortion({0, 120, 0}), std::numeric_limits<double>::infinity()) << "more than a quarter round the globe";
}

TEST(CrsTest, WhatAnOptionNamesWronglyIsWrongUsage) {
  EXPECT_EQ(horizontal_option_crs("--bbox-crs", "EPSG:25832+7837").name(), "EPSG:25832");
  EXPECT_EQ(vertical_option_crs("--assume-vertical", "EPSG:7837").name(), "EPSG:7837");
  const auto cause = [](auto&& named) -> std::string {
    try {
      named();
      return "";
    } catch (const UsageError& error) {
      return error.what();
    }
  };
  EXPECT_TRUE(cause([] { option_crs("--crs", "nonsense"); }).starts_with("--crs: "));
  EXPECT_TRUE(cause([] { horizontal_option_crs("--bbox-crs", "EPSG:7837"); }).starts_with("--bbox-crs EPSG:7837 has heights only"));
  EXPECT_TRUE(cause([] { vertical_option_crs("--assume-vertical", "EPSG:25832"); }).starts_with("--assume-vertical EPSG:25832 is no vertical CRS"));
}

}  // namespace
