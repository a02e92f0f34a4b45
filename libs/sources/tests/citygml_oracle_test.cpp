// The same geometry as libcitygml finds, on the real files that libcitygml reads. libcitygml is the oracle, nothing else uses it.
#pragma GCC diagnostic ignored "-Wnon-virtual-dtor"   // of libcitygml's logger
#include <citygml/citygml.h>
#include <citygml/citygmllogger.h>
#include <citygml/citymodel.h>
#include <citygml/cityobject.h>
#include <citygml/geometry.h>
#include <citygml/polygon.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include <priormap/sources/citygml_reader.hpp>

#include "model_test_support.hpp"

namespace priormap {
namespace {

using Type = citygml::CityObject::CityObjectsType;

std::filesystem::path shared_citygml() {
  const char* folder = std::getenv("PRIORMAP_SHARED_DATA");
  return std::filesystem::path(folder ? folder : PRIORMAP_SOURCE_DIR "/../shared/data") / "citygml";
}

class Silent : public citygml::CityGMLLogger {
 public:
  Silent() : CityGMLLogger(LOGLEVEL::LL_ERROR) {}
  void log(LOGLEVEL, const std::string&, const char*, int) const override {}
};

SurfaceClass class_of(Type type, SurfaceClass inherited) {
  switch (type) {
    case Type::COT_WallSurface: return SurfaceClass::wall;
    case Type::COT_RoofSurface: return SurfaceClass::roof;
    case Type::COT_GroundSurface: return SurfaceClass::ground_surface;
    case Type::COT_ClosureSurface: return SurfaceClass::closure;
    case Type::COT_OuterCeilingSurface: return SurfaceClass::outer_ceiling;
    case Type::COT_OuterFloorSurface: return SurfaceClass::outer_floor;
    case Type::COT_Window: case Type::COT_Door: return SurfaceClass::opening;
    case Type::COT_BuildingInstallation: return SurfaceClass::unclassified;
    default: return inherited;
  }
}

/// Areas of the distinct polygons of objects and those below them.
struct OracleAreas {
  std::map<SurfaceClass, double> areas;
  std::set<const citygml::Polygon*> seen;
  std::size_t buildings = 0;

  static Ring3 ring(const citygml::LinearRing& r) {
    Ring3 points;
    for (const TVec3d& v : r.getVertices()) points.emplace_back(v.x, v.y, v.z);
    return points;
  }

  void add(const citygml::Geometry& geometry, SurfaceClass surface_class) {
    for (unsigned i = 0; i < geometry.getPolygonsCount(); ++i) {
      const auto polygon = geometry.getPolygon(i);
      if (!seen.insert(polygon.get()).second || !polygon->exteriorRing()) continue;
      Polygon3 copy{ring(*polygon->exteriorRing()), {}};
      for (const auto& hole : polygon->interiorRings()) copy.holes.push_back(ring(*hole));
      if (!copy.exterior.empty()) areas[surface_class] += polygon_area(copy);
    }
    for (unsigned i = 0; i < geometry.getGeometriesCount(); ++i) add(geometry.getGeometry(i), surface_class);
  }

  /// Boundary surfaces first: a solid repeats their polygons.
  void add(const citygml::CityObject& object, SurfaceClass inherited) {
    const SurfaceClass surface_class = class_of(object.getType(), inherited);
    buildings += object.getType() == Type::COT_Building;
    for (unsigned i = 0; i < object.getChildCityObjectsCount(); ++i) add(object.getChildCityObject(i), surface_class);
    for (unsigned i = 0; i < object.getGeometriesCount(); ++i) add(object.getGeometry(i), surface_class);
  }
};

class CityGmlOracle : public testing::TestWithParam<const char*> {};

TEST_P(CityGmlOracle, AreaPerSurfaceClassAgreesWithin01Percent) {
  const std::filesystem::path file = shared_citygml() / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the real inputs are absent (" << file.filename() << ")";

  citygml::ParserParams params;
  params.tesselate = false;
  params.optimize = false;
  params.pruneEmptyObjects = false;
  params.keepVertices = true;
  std::shared_ptr<const citygml::CityModel> model;
  try {
    model = citygml::load(file.string(), params, std::make_shared<Silent>());
  } catch (const std::exception& error) {
    GTEST_SKIP() << "libcitygml cannot read " << file.filename() << ": " << error.what();
  }
  ASSERT_TRUE(model);
  OracleAreas oracle;
  for (unsigned i = 0; i < model->getNumRootCityObjects(); ++i) oracle.add(model->getRootCityObject(i), SurfaceClass::unclassified);

  std::vector<BuildingModel> ours;
  read_citygml(file, {}, [&](BuildingModel&& building) { ours.push_back(std::move(building)); });
  const auto areas = area_by_class(ours);
  ASSERT_FALSE(oracle.areas.empty()) << "libcitygml found no geometry";
  for (const auto& [surface_class, area] : oracle.areas) {
    const auto found = areas.find(surface_class);
    ASSERT_NE(found, areas.end()) << "class " << static_cast<int>(surface_class) << " is missing";
    EXPECT_NEAR(found->second, area, 0.001 * area) << "class " << static_cast<int>(surface_class);
  }
  EXPECT_EQ(areas.size(), oracle.areas.size());
  EXPECT_EQ(ours.size(), oracle.buildings);
}

INSTANTIATE_TEST_SUITE_P(RealFiles, CityGmlOracle,
                         testing::Values("berlin_lod2_v1.gml", "potsdam_lod1_v1.gml", "zurich_lod2_v1.gml", "Berlin_Moabit_1Bldg_v2.gml",
                                         "DenHaag_1BwBP.gml", "ingolstadt_lod3_v2.gml"));

TEST(CityGmlVersions, TheSameBuildingIn20And30HasTheSamePolygons) {
  if (!std::filesystem::exists(shared_citygml())) GTEST_SKIP() << "the real inputs are absent";
  auto read = [](const char* name) {
    std::vector<std::pair<SurfaceClass, Ring3>> polygons;
    read_citygml(shared_citygml() / name, {}, [&](BuildingModel&& building) {
      for (ModelPolygon& p : building.polygons)
        if (!p.repeated) polygons.emplace_back(p.surface_class, std::move(p.polygon.exterior));
    });
    return polygons;
  };
  const auto v2 = read("Berlin_Moabit_1Bldg_v2.gml");
  EXPECT_EQ(v2.size(), 6u);
  EXPECT_EQ(v2, read("Berlin_Moabit_1Bldg_v3.gml"));
}

}  // namespace
}  // namespace priormap
