#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <zlib.h>

#include <priormap/core/error.hpp>
#include <priormap/sources/citygml_reader.hpp>

#include "model_test_support.hpp"

namespace priormap {
namespace {

std::string document(const std::string& members, const std::string& srs = "EPSG:25832") {
  return "<?xml version='1.0'?><core:CityModel xmlns:core='http://www.opengis.net/citygml/2.0' xmlns:bldg='http://www.opengis.net/citygml/building/2.0' "
         "xmlns:gml='http://www.opengis.net/gml' xmlns:xlink='http://www.w3.org/1999/xlink'>"
         "<gml:boundedBy><gml:Envelope srsName='" + srs + "'/></gml:boundedBy>" + members + "</core:CityModel>";
}
std::string building(const std::string& content, const std::string& id = "b1") {
  return "<core:cityObjectMember><bldg:Building gml:id='" + id + "'>" + content + "</bldg:Building></core:cityObjectMember>";
}
/// A unit square at height z; `id` may be empty.
std::string square(const std::string& id, double z, double size = 1) {
  const std::string a = std::to_string(size), h = std::to_string(z);
  return "<gml:Polygon" + (id.empty() ? "" : " gml:id='" + id + "'") + "><gml:exterior><gml:LinearRing><gml:posList>0 0 " + h + " " + a + " 0 " + h + " " + a + " " + a +
         " " + h + " 0 " + a + " " + h + " 0 0 " + h + "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>";
}
std::string member(const std::string& geometry) { return "<gml:surfaceMember>" + geometry + "</gml:surfaceMember>"; }
std::string turned(const std::string& geometry) { return "<gml:OrientableSurface orientation='-'><gml:baseSurface>" + geometry + "</gml:baseSurface></gml:OrientableSurface>"; }
std::string link(const std::string& id) { return "<gml:surfaceMember xlink:href='#" + id + "'/>"; }
std::string surface(const std::string& name, const std::string& geometry, int lod = 2) {
  const std::string property = "bldg:lod" + std::to_string(lod) + "MultiSurface";
  return "<bldg:boundedBy><bldg:" + name + "><" + property + "><gml:MultiSurface>" + geometry + "</gml:MultiSurface></" + property + "></bldg:" + name + "></bldg:boundedBy>";
}
std::string solid(const std::string& geometry, int lod = 2) {
  const std::string property = "bldg:lod" + std::to_string(lod) + "Solid";
  return "<" + property + "><gml:Solid><gml:exterior><gml:CompositeSurface>" + geometry + "</gml:CompositeSurface></gml:exterior></gml:Solid></" + property + ">";
}

std::vector<BuildingModel> read(const std::string& text, const BuildingModelOptions& options = {}) {
  const TemporaryFile file(".gml", text);
  std::vector<BuildingModel> models;
  read_citygml(file.path(), options, [&](BuildingModel&& model) { models.push_back(std::move(model)); });
  return models;
}

TEST(CityGml, APolygonThatSolidAndWallShareCountsOnceAsWall) {
  for (const std::string& content : {surface("WallSurface", member(square("p", 0))) + solid(link("p")),      // stated by the wall
                                     solid(member(square("p", 0))) + surface("WallSurface", link("p")),      // stated by the solid
                                     solid(member(square("", 0))) + surface("WallSurface", member(square("", 0)))}) {   // stated twice
    const auto models = read(document(building(content)));
    ASSERT_EQ(models.size(), 1u);
    ASSERT_EQ(models[0].polygons.size(), 1u) << content;
    EXPECT_EQ(models[0].polygons[0].surface_class, SurfaceClass::wall);
    EXPECT_EQ(models[0].unresolved_references, 0u);
    EXPECT_EQ(models[0].srs_name, "EPSG:25832");
    EXPECT_DOUBLE_EQ(polygon_area(models[0].polygons[0].polygon), 1.0);
  }
}

TEST(CityGml, APartyWallIsAFaceOfEachBodyThatItParts) {
  const std::string toward = member(square("", 0)), away = member(turned(square("", 0)));
  const auto part = [](const std::string& content) { return "<bldg:consistsOfBuildingPart><bldg:BuildingPart>" + content + "</bldg:BuildingPart></bldg:consistsOfBuildingPart>"; };
  const auto body = [](const std::string& geometry) {
    return "<gml:solidMember><gml:Solid><gml:exterior><gml:CompositeSurface>" + geometry + "</gml:CompositeSurface></gml:exterior></gml:Solid></gml:solidMember>";
  };
  const std::string bodies = "<bldg:lod2Solid><gml:CompositeSolid>" + body(toward) + body(away) + "</gml:CompositeSolid></bldg:lod2Solid>";
  for (const std::string& content : {part(solid(toward)) + part(solid(away)), part(surface("WallSurface", toward)) + part(surface("WallSurface", away)), bodies})
    EXPECT_EQ(read(document(building(content)))[0].polygons.size(), 2u) << content;
  const auto twice = read(document(building(part(solid(toward)) + part(solid(toward)))))[0].polygons;   // a face of both parts, to be built once
  ASSERT_EQ(twice.size(), 2u);
  EXPECT_FALSE(twice[0].repeated);
  EXPECT_TRUE(twice[1].repeated);
  EXPECT_EQ(read(document(building(part(solid(toward) + surface("WallSurface", away)))))[0].polygons.size(), 1u);   // the same body, carelessly wound
}

TEST(CityGml, APolygonIsOfEachPartThatRefersToIt) {
  const auto part = [](const std::string& content) { return "<bldg:consistsOfBuildingPart><bldg:BuildingPart>" + content + "</bldg:BuildingPart></bldg:consistsOfBuildingPart>"; };
  const auto models = read(document(building(solid(member(square("p", 0))) + part(solid(link("p"))) + part(solid(link("p"))))));
  ASSERT_EQ(models[0].polygons.size(), 3u);
  std::set<int> parts;
  for (const ModelPolygon& polygon : models[0].polygons) parts.insert(polygon.part);
  EXPECT_EQ(parts.size(), 3u);
  EXPECT_EQ(std::ranges::count(models[0].polygons, false, &ModelPolygon::repeated), 1);
}

TEST(CityGml, APolygonIsOfEachSolidThatRefersToIt) {
  const auto body = [](const std::string& geometry) {
    return "<gml:solidMember><gml:Solid><gml:exterior><gml:CompositeSurface>" + geometry + "</gml:CompositeSurface></gml:exterior></gml:Solid></gml:solidMember>";
  };
  const auto bodies = [&](const std::string& a, const std::string& b) { return "<bldg:lod2Solid><gml:CompositeSolid>" + body(a) + body(b) + "</gml:CompositeSolid></bldg:lod2Solid>"; };
  const std::string stated = member(square("p", 0)), turned_link = member("<gml:OrientableSurface orientation='-'><gml:baseSurface xlink:href='#p'/></gml:OrientableSurface>");
  const std::string wall = surface("WallSurface", stated);
  for (const std::string& content : {bodies(stated, turned_link), bodies(turned_link, stated), wall + bodies(link("p"), turned_link), bodies(turned_link, link("p")) + wall}) {
    const auto polygons = read(document(building(content)))[0].polygons;
    ASSERT_EQ(polygons.size(), 2u) << content;
    EXPECT_NE(polygons[0].solid, polygons[1].solid);
    EXPECT_LT(newell_normal(polygons[0].polygon).dot(newell_normal(polygons[1].polygon)), 0) << content;
    for (const ModelPolygon& polygon : polygons) {
      EXPECT_TRUE(polygon.shared);
      EXPECT_FALSE(polygon.repeated);
    }
  }
  const auto alike = read(document(building(bodies(stated, link("p")))))[0].polygons;   // which of the two it looks into is not said
  ASSERT_EQ(alike.size(), 2u);
  EXPECT_TRUE(alike[1].shared);
  EXPECT_TRUE(alike[1].repeated);
}

TEST(CityGml, EveryPartAndSurfaceMayStateItsEnvelopeAndIsStillOfItsBuilding) {
  const std::string envelope = "<gml:boundedBy><gml:Envelope srsName='CH1903'/></gml:boundedBy>";
  const auto wall = [&](double z) {
    return "<bldg:boundedBy><bldg:WallSurface>" + envelope + "<bldg:lod2MultiSurface><gml:MultiSurface>" + member(square("", z)) +
           "</gml:MultiSurface></bldg:lod2MultiSurface></bldg:WallSurface></bldg:boundedBy>";
  };
  const std::string part = "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id='part'>" + envelope + wall(1) + "</bldg:BuildingPart></bldg:consistsOfBuildingPart>";
  const auto models = read(document(building(envelope + wall(0) + part) + building(envelope + wall(2), "b2")));
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].polygons.size(), 2u);
  EXPECT_EQ(models[0].srs_name, "CH1903");
  EXPECT_EQ(models[1].polygons.size(), 1u);
}

TEST(CityGml, BridgesHaveTheirPartsAndElementsAndNoRooms) {
  const auto at = [](const std::string& property, double z) { return "<brid:" + property + "><gml:MultiSurface>" + member(square("", z)) + "</gml:MultiSurface></brid:" + property + ">"; };
  const std::string bridge =
      "<core:cityObjectMember><brid:Bridge gml:id='span'><brid:boundedBy><brid:RoofSurface>" + at("lod2MultiSurface", 5) + "</brid:RoofSurface></brid:boundedBy>"
      "<brid:outerBridgeConstruction><brid:BridgeConstructionElement>" + at("lod2Geometry", 1) + "</brid:BridgeConstructionElement></brid:outerBridgeConstruction>"
      "<brid:consistsOfBridgePart><brid:BridgePart>" + at("lod2MultiSurface", 6) + "</brid:BridgePart></brid:consistsOfBridgePart>"
      "<brid:interiorBridgeRoom><brid:BridgeRoom>" + at("lod4MultiSurface", 3) + "</brid:BridgeRoom></brid:interiorBridgeRoom></brid:Bridge></core:cityObjectMember>";
  const auto models = read(document(bridge + building(solid(member(square("", 0))))));
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].kind, ModelKind::bridge);
  EXPECT_EQ(models[0].polygons.size(), 3u);
  EXPECT_EQ(models[1].kind, ModelKind::building);
  EXPECT_EQ(read(document(bridge), {.bridges = false}).size(), 0u);
}

TEST(CityGml, PlantsAreReadWhereWanted) {
  const std::string tree = "<core:cityObjectMember><veg:SolitaryVegetationObject gml:id='oak'><veg:lod2Geometry><gml:MultiSurface>" + member(square("", 7)) +
                           "</gml:MultiSurface></veg:lod2Geometry></veg:SolitaryVegetationObject></core:cityObjectMember>";
  const std::string hedge = "<core:cityObjectMember><veg:PlantCover gml:id='hedge'><veg:lod1MultiSolid><gml:MultiSolid><gml:solidMember><gml:Solid><gml:exterior><gml:CompositeSurface>" +
                            member(square("", 1)) + "</gml:CompositeSurface></gml:exterior></gml:Solid></gml:solidMember></gml:MultiSolid></veg:lod1MultiSolid></veg:PlantCover></core:cityObjectMember>";
  const auto models = read(document(tree + hedge));
  ASSERT_EQ(models.size(), 2u);
  for (const BuildingModel& model : models) {
    EXPECT_EQ(model.kind, ModelKind::vegetation);
    EXPECT_EQ(model.polygons.size(), 1u) << model.id;
  }
  EXPECT_EQ(read(document(tree + hedge), {.vegetation = false}).size(), 0u);
}

TEST(CityGml, TheHighestLevelOfEachPartIsTakenUnlessOneIsAskedFor) {
  const std::string part = "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id='part'>" + solid(member(square("", 5, 2)), 1) +
                           surface("RoofSurface", member(square("", 7, 3))) + "</bldg:BuildingPart></bldg:consistsOfBuildingPart>";
  const std::string text = document(building(solid(member(square("", 1)), 1) + part));
  const auto best = read(text);
  ASSERT_EQ(best[0].polygons.size(), 1u);   // the building's own LoD1 block repeats what its LoD2 part says better
  EXPECT_EQ(best[0].lod, 2);
  EXPECT_DOUBLE_EQ(polygon_area(best[0].polygons[0].polygon), 9.0);
  EXPECT_EQ(read(text, {.lod = 1})[0].polygons.size(), 2u);
}

TEST(CityGml, ReferencesReachOtherBuildingsAndEndInCirclesOrNowhere) {
  const std::string first = building(surface("WallSurface", link("far")), "b1");
  const std::string second = building(surface("WallSurface", member(square("far", 3))), "b2");
  const auto models = read(document(first + second));
  ASSERT_EQ(models.size(), 2u);
  for (const BuildingModel& model : models) EXPECT_EQ(model.polygons.size(), 1u) << model.id;

  const std::string circle = "<gml:surfaceMember><gml:CompositeSurface gml:id='x'>" + link("y") + "</gml:CompositeSurface></gml:surfaceMember>"
                             "<gml:surfaceMember><gml:CompositeSurface gml:id='y'>" + link("x") + "</gml:CompositeSurface></gml:surfaceMember>";
  const auto odd = read(document(building(solid(circle + link("nowhere")))));
  EXPECT_TRUE(odd[0].polygons.empty());
  EXPECT_EQ(odd[0].unresolved_references, 1u);
}

TEST(CityGml, AnOrientedSurfaceTurnsItsPolygonOver) {
  const auto models = read(document(building(solid(member(turned(square("", 0)))))));
  const Ring3& ring = models[0].polygons[0].polygon.exterior;
  EXPECT_LT((ring[1] - ring[0]).cross(ring[2] - ring[0]).z(), 0);
}

TEST(CityGml, AReferenceToAnOrientedSurfaceBringsItsOrientation) {
  const auto part = [](const std::string& content) { return "<bldg:consistsOfBuildingPart><bldg:BuildingPart>" + content + "</bldg:BuildingPart></bldg:consistsOfBuildingPart>"; };
  const auto body = [](const std::string& geometry) {
    return "<gml:solidMember><gml:Solid><gml:exterior><gml:CompositeSurface>" + geometry + "</gml:CompositeSurface></gml:exterior></gml:Solid></gml:solidMember>";
  };
  const std::string oriented = "<gml:OrientableSurface gml:id='o' orientation='-'><gml:baseSurface>" + square("p", 0) + "</gml:baseSurface></gml:OrientableSurface>";
  const std::string of_both = "<gml:CompositeSurface gml:id='c'>" + member(oriented) + "</gml:CompositeSurface>";
  const std::string turned_link = member("<gml:OrientableSurface orientation='-'><gml:baseSurface xlink:href='#o'/></gml:OrientableSurface>");
  for (const auto& [reference, looks_up] : {std::pair(link("p"), true), {link("o"), false}, {link("c"), false}, {turned_link, true}}) {
    const std::string stated = solid(member(of_both)), referring = solid(reference);
    for (const auto& models : {read(document(building(part(stated) + part(referring)))), read(document(building(part(referring) + part(stated)))), read(document(building(stated) + building(referring, "b2")))}) {
      std::vector<double> heights;
      for (const BuildingModel& model : models)
        for (const ModelPolygon& polygon : model.polygons)
          if (polygon.shared) heights.push_back(newell_normal(polygon.polygon).z());
      ASSERT_EQ(heights.size(), 1u) << reference;
      EXPECT_EQ(heights[0] > 0, looks_up) << reference;
    }
    const std::string stating_body = body(member(of_both) + member(square("", 5))), referring_body = body(reference);
    for (const bool refers_first : {false, true}) {   // two solids of one part
      const std::string bodies = refers_first ? referring_body + stating_body : stating_body + referring_body;
      const auto polygons = read(document(building("<bldg:lod2Solid><gml:CompositeSolid>" + bodies + "</gml:CompositeSolid></bldg:lod2Solid>")))[0].polygons;
      ASSERT_EQ(polygons.size(), 3u) << reference;
      for (const ModelPolygon& polygon : polygons) {
        const bool refers = polygon.solid == (refers_first ? 1 : 2);
        if (polygon.shared) {
          EXPECT_EQ(newell_normal(polygon.polygon).z() > 0, refers && looks_up) << reference;
        }
      }
    }
  }
}

TEST(CityGml, ASolidSaysWhichWayItsBoundarySurfaceLooks) {
  const auto looks_up = [](const std::string& content) {
    const auto models = read(document(building(content)));
    EXPECT_EQ(models[0].polygons.size(), 1u);
    return newell_normal(models[0].polygons[0].polygon).z() > 0;
  };
  const std::string upward = surface("RoofSurface", member(square("p", 0))), downward = surface("RoofSurface", member(turned(square("p", 0))));
  const std::string turned_link = member("<gml:OrientableSurface orientation='-'><gml:baseSurface xlink:href='#p'/></gml:OrientableSurface>");
  EXPECT_TRUE(looks_up(upward + solid(link("p"))));
  EXPECT_FALSE(looks_up(upward + solid(turned_link)));
  EXPECT_FALSE(looks_up(solid(turned_link) + upward));
  EXPECT_TRUE(looks_up(downward + solid(link("p"))));   // to what the surface turns, not to what it has turned
}

TEST(CityGml, TheVoidInsideASolidIsNotSeen) {
  const std::string hollow = "<bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface>" + member(square("", 0, 4)) + "</gml:CompositeSurface></gml:exterior>"
                             "<gml:interior><gml:CompositeSurface>" + member(square("", 1)) + "</gml:CompositeSurface></gml:interior></gml:Solid></bldg:lod2Solid>";
  const auto models = read(document(building(hollow)));
  ASSERT_EQ(models[0].polygons.size(), 1u);
  EXPECT_DOUBLE_EQ(polygon_area(models[0].polygons[0].polygon), 16);
}

TEST(CityGml, AMirroredTemplateLooksOutwardStill) {
  const std::string installation =
      "<bldg:outerBuildingInstallation><bldg:BuildingInstallation><bldg:lod3ImplicitRepresentation><core:ImplicitGeometry>"
      "<core:transformationMatrix>-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</core:transformationMatrix><core:relativeGMLGeometry><gml:MultiSurface>" + member(square("", 0)) +
      "</gml:MultiSurface></core:relativeGMLGeometry></core:ImplicitGeometry></bldg:lod3ImplicitRepresentation></bldg:BuildingInstallation></bldg:outerBuildingInstallation>";
  const auto models = read(document(building(installation)));
  ASSERT_EQ(models[0].polygons.size(), 1u);
  EXPECT_GT(newell_normal(models[0].polygons[0].polygon).z(), 0);   // the lid of a box is its lid when left and right are swapped
  EXPECT_DOUBLE_EQ(models[0].polygons[0].polygon.exterior[1].x(), -1);
}

TEST(CityGml, ImplicitGeometryIsPlacedByMatrixAndReferencePointAndSharedById) {
  auto placed = [](const std::string& geometry, int x) {
    return "<bldg:outerBuildingInstallation><bldg:BuildingInstallation><bldg:lod3ImplicitRepresentation><core:ImplicitGeometry>"
           "<core:transformationMatrix>2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1</core:transformationMatrix>" + geometry +
           "<core:referencePoint><gml:Point><gml:pos>" + std::to_string(x) + " 0 10</gml:pos></gml:Point></core:referencePoint>"
           "</core:ImplicitGeometry></bldg:lod3ImplicitRepresentation></bldg:BuildingInstallation></bldg:outerBuildingInstallation>";
  };
  const std::string stated = "<core:relativeGMLGeometry><gml:MultiSurface gml:id='shape'>" + member(square("", 1)) + "</gml:MultiSurface></core:relativeGMLGeometry>";
  const std::string linked = "<core:relativeGMLGeometry xlink:href='#shape'/>";
  for (const bool template_first : {true, false}) {
    const std::string a = building(placed(stated, 100), "a"), b = building(placed(linked, 200) + placed(linked, 300), "b");
    const auto models = read(document(template_first ? a + b : b + a));
    ASSERT_EQ(models.size(), 2u);
    std::vector<double> corners;
    for (const BuildingModel& model : models) {
      for (const ModelPolygon& p : model.polygons) {
        EXPECT_DOUBLE_EQ(polygon_area(p.polygon), 4.0);
        EXPECT_DOUBLE_EQ(p.polygon.exterior[0].z(), 12.0);
        corners.push_back(p.polygon.exterior[0].x());
      }
    }
    std::sort(corners.begin(), corners.end());
    EXPECT_EQ(corners, (std::vector<double>{100, 200, 300}));
  }
}

TEST(CityGml, TemplatesPlacedBeyondWhatABuildingMayHoldAreRefused) {
  std::string ring;
  for (int i = 0; i < 40'000; ++i) ring += std::to_string(i) + " " + std::to_string(i % 2) + " 0 ";
  const std::string huge = "<gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>" + ring + "0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>";
  const auto placed = [](const std::string& geometry, int x = 0) {
    return "<bldg:outerBuildingInstallation><bldg:BuildingInstallation><bldg:lod3ImplicitRepresentation><core:ImplicitGeometry>" + geometry +
           "<core:referencePoint><gml:Point><gml:pos>" + std::to_string(x) + " 0 10</gml:pos></gml:Point></core:referencePoint>"
           "</core:ImplicitGeometry></bldg:lod3ImplicitRepresentation></bldg:BuildingInstallation></bldg:outerBuildingInstallation>";
  };
  const std::string stated = building(placed("<core:relativeGMLGeometry><gml:MultiSurface gml:id='shape'>" + member(huge) + "</gml:MultiSurface></core:relativeGMLGeometry>"), "a");
  BuildingModelOptions options;
  const auto message = [&](int buildings, int placements, bool in_one_place = false) -> std::string {
    std::string text = stated;
    for (int b = 0; b < buildings; ++b) {
      std::string all;
      for (int i = 0; i < placements; ++i) all += placed("<core:relativeGMLGeometry xlink:href='#shape'/>", in_one_place ? 0 : i);
      text += building(all, "b" + std::to_string(b));
    }
    const TemporaryFile file(".gml", document(text));
    try {
      read_citygml(file.path(), options, [](BuildingModel&&) {});
      return "";
    } catch (const FormatError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message(2, 150), "");
  EXPECT_NE(message(1, 250).find("more than 8 million vertices"), std::string::npos);
  EXPECT_NE(message(6, 150).find("more than 32 million vertices"), std::string::npos);
  EXPECT_EQ(message(6, 150, true), "");   // of which one is kept
  // What no longer fits beside polygons that are no templates is left out, and does not count for the file.
  const auto body = [](const std::string& geometry) {
    return "<gml:solidMember><gml:Solid><gml:exterior><gml:CompositeSurface>" + geometry + "</gml:CompositeSurface></gml:exterior></gml:Solid></gml:solidMember>";
  };
  std::string bodies, placements, full = stated + building(solid(member("<gml:CompositeSurface gml:id='wall'>" + member(huge) + "</gml:CompositeSurface>"), 3), "w");
  for (int i = 0; i < 195; ++i) bodies += body(link("wall"));
  for (int i = 0; i < 190; ++i) placements += placed("<core:relativeGMLGeometry xlink:href='#shape'/>", i);
  for (int b = 0; b < 5; ++b) full += building("<bldg:lod3Solid><gml:CompositeSolid>" + bodies + "</gml:CompositeSolid></bldg:lod3Solid>" + placements, "b" + std::to_string(b));
  std::size_t unresolved = 0;
  const TemporaryFile file(".gml", document(full));
  read_citygml(file.path(), options, [&](BuildingModel&& model) { unresolved += model.unresolved_references; });
  EXPECT_EQ(unresolved, 5u * (195 + 190 - 200));
  options.lod = 2;   // as the messages say
  EXPECT_EQ(message(1, 250), "");
  EXPECT_EQ(message(6, 150), "");
}

TEST(CityGml, HolesOldGmlSyntaxAndInnermostSrsNameAreRead) {
  const std::string polygon = "<gml:Polygon srsName='EPSG:25833'><gml:outerBoundaryIs><gml:LinearRing><gml:coordinates>0,0,0 4,0,0 4,4,0 0,4,0 0,0,0</gml:coordinates>"
                              "</gml:LinearRing></gml:outerBoundaryIs><gml:innerBoundaryIs><gml:LinearRing><gml:pos>1 1 0</gml:pos><gml:pos>1 2 0</gml:pos>"
                              "<gml:pos>2 2 0</gml:pos><gml:pos>2 1 0</gml:pos></gml:LinearRing></gml:innerBoundaryIs></gml:Polygon>";
  const auto models = read(document(building(solid(member(polygon)))));
  ASSERT_EQ(models[0].polygons.size(), 1u);
  EXPECT_DOUBLE_EQ(polygon_area(models[0].polygons[0].polygon), 15.0);
  EXPECT_FALSE(models[0].polygons[0].closed);   // the hole does not repeat its first point
  EXPECT_EQ(models[0].srs_name, "EPSG:25833");
}

TEST(CityGml, OpeningsClosuresAndInstallationsKeepTheirClassInEveryVersion) {
  const std::string window = "<bldg:opening><bldg:Window><bldg:lod3MultiSurface><gml:MultiSurface>" + member(square("", 2)) + "</gml:MultiSurface></bldg:lod3MultiSurface></bldg:Window></bldg:opening>";
  const std::string filling = "<con:fillingSurface><con:WindowSurface><core:lod3MultiSurface><gml:MultiSurface>" + member(square("", 2)) +
                              "</gml:MultiSurface></core:lod3MultiSurface></con:WindowSurface></con:fillingSurface>";
  for (const std::string& opening : {window, filling}) {
    const std::string wall = "<bldg:boundedBy><bldg:WallSurface><bldg:lod3MultiSurface><gml:MultiSurface>" + member(square("", 0, 3)) + "</gml:MultiSurface></bldg:lod3MultiSurface>" +
                             opening + "</bldg:WallSurface></bldg:boundedBy>";
    const auto areas = area_by_class(read(document(building(wall + surface("ClosureSurface", member(square("", 5, 2)), 3) + surface("GroundSurface", member(square("", 6, 4)), 3)))));
    EXPECT_DOUBLE_EQ(areas.at(SurfaceClass::wall), 9);
    EXPECT_DOUBLE_EQ(areas.at(SurfaceClass::opening), 1);
    EXPECT_DOUBLE_EQ(areas.at(SurfaceClass::closure), 4);
    EXPECT_DOUBLE_EQ(areas.at(SurfaceClass::ground_surface), 16);
  }
}

TEST(CityGml, TriangulatedAndCompositeSurfacesOfSolidsAreTheirPolygons) {
  const std::string triangles = "<gml:surfaceMember><gml:TriangulatedSurface><gml:trianglePatches>"
                                "<gml:Triangle><gml:exterior><gml:LinearRing><gml:posList>0 0 0 1 0 0 1 1 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Triangle>"
                                "<gml:Triangle><gml:exterior><gml:LinearRing><gml:posList>0 0 0 1 1 0 0 1 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Triangle>"
                                "</gml:trianglePatches></gml:TriangulatedSurface></gml:surfaceMember>";
  const std::string patches = "<gml:surfaceMember><gml:Surface><gml:patches><gml:PolygonPatch><gml:exterior><gml:LinearRing><gml:posList>0 0 4 2 0 4 2 2 4 0 2 4 0 0 4</gml:posList>"
                              "</gml:LinearRing></gml:exterior></gml:PolygonPatch></gml:patches></gml:Surface></gml:surfaceMember>";
  const auto models = read(document(building(solid("<gml:surfaceMember><gml:CompositeSurface>" + triangles + patches + "</gml:CompositeSurface></gml:surfaceMember>"))));
  ASSERT_EQ(models[0].polygons.size(), 3u);
  EXPECT_DOUBLE_EQ(area_by_class(models).at(SurfaceClass::unclassified), 5);
}

TEST(CityGml, SrsNameComesFromTheBuildingsEnvelopeOrTheDocuments) {
  const std::string own = "<gml:boundedBy><gml:Envelope srsName='EPSG:25833'/></gml:boundedBy>";
  const auto models = read(document(building(own + solid(member(square("", 0))), "a") + building(solid(member(square("", 0))), "b")));
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].srs_name, "EPSG:25833");
  EXPECT_EQ(models[1].srs_name, "EPSG:25832");
}

TEST(CityGml, RoomsTerrainIntersectionsAndFootprintsAreLeftOut) {
  const auto models = read(document(building(
      "<bldg:lod0FootPrint><gml:MultiSurface>" + member(square("", 0)) + "</gml:MultiSurface></bldg:lod0FootPrint>"
      "<bldg:interiorRoom><bldg:Room><bldg:lod4Solid><gml:Solid><gml:exterior>" + square("", 1) + "</gml:exterior></gml:Solid></bldg:lod4Solid></bldg:Room></bldg:interiorRoom>" +
      surface("RoofSurface", member(square("", 9))))));
  ASSERT_EQ(models[0].polygons.size(), 1u);
  EXPECT_EQ(models[0].lod, 2);
}

TEST(CityGml, GzipIsReadAndDamageIsNamedByLine) {
  const std::string text = document(building(solid(member(square("", 0)))));
  const TemporaryFile packed(".gml.gz", "");
  gzFile out = gzopen(packed.path().c_str(), "wb");
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  std::size_t polygons = 0;
  read_citygml(packed.path(), {}, [&](BuildingModel&& model) { polygons += model.polygons.size(); });
  EXPECT_EQ(polygons, 1u);

  auto message = [](const std::string& broken) -> std::string {
    try {
      read(broken);
      return "";
    } catch (const FormatError& error) {
      return error.what();
    }
  };
  EXPECT_NE(message(text.substr(0, text.size() / 2)).find("line 1"), std::string::npos);
  EXPECT_NE(message("<html/>").find("no CityGML"), std::string::npos);
  EXPECT_NE(message("<!DOCTYPE x [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;'>]><CityModel>&b;</CityModel>").find("entity"), std::string::npos);
  std::string deep = "<CityModel>";
  for (int i = 0; i < 5000; ++i) deep += "<a>";
  EXPECT_NE(message(deep).find("nested deeper"), std::string::npos);
}

TEST(CityGml, EncodingsOfOneByteACharacterAreRead) {
  const auto id_in = [](const std::string& encoding, const std::string& id) {
    std::string text = document(building(surface("WallSurface", member(square("", 0))), id));
    const std::string plain = "<?xml version='1.0'?>";
    text.replace(0, plain.size(), "<?xml version='1.0' encoding='" + encoding + "'?>");
    const auto models = read(text);
    return models.size() == 1 ? models[0].id : "none";
  };
  for (const std::string encoding : {"windows-1252", "Windows-1252", "CP1252"}) EXPECT_EQ(id_in(encoding, "Stra\xdf" "e_\x80"), "Stra\u00dfe_\u20ac") << encoding;
  EXPECT_EQ(id_in("ISO-8859-15", "caf\xe9_\xa4"), "caf\u00e9_\u20ac");
  EXPECT_EQ(id_in("ISO-8859-1", "caf\xe9"), "caf\u00e9") << "expat's own";
  EXPECT_EQ(id_in("windows-1250", "\xe8\xe1st"), "\u010d\u00e1st");
  EXPECT_EQ(id_in("KOI8-R", "\xc4\xcf\xcd"), "\u0434\u043e\u043c");
}

TEST(CityGml, OtherEncodingsAreNamedWithTheRemedy) {
  for (const std::string encoding : {"GBK", "Shift_JIS", "UTF-7", "ISO-2022-JP", "EBCDIC-US", "no-such"}) {
    std::string text = document(building(""));
    text.replace(0, text.find("?>"), "<?xml version='1.0' encoding='" + encoding + "'");
    try {
      read(text);
      ADD_FAILURE() << encoding << " was read";
    } catch (const FormatError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("'" + encoding + "'"), std::string::npos) << message;
      EXPECT_NE(message.find("iconv -f " + encoding + " -t UTF-8"), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace priormap
