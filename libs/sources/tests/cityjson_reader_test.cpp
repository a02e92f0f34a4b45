#include <gtest/gtest.h>

#include <tuple>

#include <priormap/core/error.hpp>
#include <priormap/sources/cityjson_reader.hpp>

#include "model_test_support.hpp"

namespace priormap {
namespace {

std::vector<BuildingModel> read(const std::string& text, const BuildingModelOptions& options = {}, const std::string& extension = ".json") {
  const TemporaryFile file(extension, text);
  std::vector<BuildingModel> models;
  read_cityjson(file.path(), cityjson_layout(file.path()), options, [&](BuildingModel&& model) { models.push_back(std::move(model)); });
  return models;
}

const std::string vertices = R"("vertices":[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,3000]])";
const std::string head = R"("type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],"translate":[500000,5000000,100]},
  "metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415"})";

TEST(CityJson, VerticesMayComeBeforeOrAfterTheObjects) {
  const std::string objects = R"("CityObjects":{"b":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2.2","boundaries":[[[0,1,2,3]]],
    "semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[0]}}]}})";
  for (const std::string& text : {"{" + head + "," + objects + "," + vertices + "}", "{" + vertices + "," + objects + "," + head + "}"}) {
    const auto models = read(text);
    ASSERT_EQ(models.size(), 1u);
    EXPECT_EQ(models[0].lod, 2);
    EXPECT_EQ(models[0].srs_name, "https://www.opengis.net/def/crs/EPSG/0/7415");
    ASSERT_EQ(models[0].polygons.size(), 1u);
    EXPECT_EQ(models[0].polygons[0].surface_class, SurfaceClass::roof);
    EXPECT_NEAR(polygon_area(models[0].polygons[0].polygon), 1.0, 1e-6);
    EXPECT_DOUBLE_EQ(models[0].polygons[0].polygon.exterior[2].x(), 500001.0);
  }
}

TEST(CityJson, AmongLevelsOfOneMajorNumberTheFinestCounts) {
  const std::string text = "{" + head + "," + vertices + R"(,"CityObjects":{
    "b":{"type":"Building","children":["p"],"geometry":[{"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]}]},
    "p":{"type":"BuildingPart","parents":["b"],"geometry":[
      {"type":"Solid","lod":"1.2","boundaries":[[[[0,1,2]]]]},
      {"type":"Solid","lod":"1.3","boundaries":[[[[0,1,2]],[[0,2,3]]]]},
      {"type":"Solid","lod":"2.2","boundaries":[[[[0,1,2,3]],[[0,1,4]],[[1,2,4]]]],"semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"WallSurface"}],"values":[[0,1,null]]}}]}}})";
  const auto best = read(text);
  ASSERT_EQ(best.size(), 1u);
  EXPECT_EQ(best[0].id, "b");
  EXPECT_EQ(best[0].polygons.size(), 3u);
  EXPECT_EQ(read(text, {.lod = 1})[0].polygons.size(), 2u);
  const auto areas = area_by_class(best);
  EXPECT_NEAR(areas.at(SurfaceClass::ground_surface), 1.0, 1e-6);
  EXPECT_NEAR(areas.at(SurfaceClass::wall), 1.5, 1e-6);
}

TEST(CityJson, BridgesHaveTheirMembersAndPlantsAreReadWhereWanted) {
  const std::string surface = R"("geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2,3]]]}])", triangle = R"("geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,4]]]}])";
  const std::string text = "{" + head + "," + vertices + R"(,"CityObjects":{"span":{"type":"Bridge","children":["pier"],)" + surface + R"(},
    "pier":{"type":"BridgeConstructiveElement","parents":["span"],)" + triangle + R"(},"room":{"type":"BridgeRoom","parents":["span"],)" + surface + R"(},
    "oak":{"type":"SolitaryVegetationObject",)" + triangle + R"(},"hedge":{"type":"PlantCover",)" + surface + "}}}";
  const auto models = read(text);
  ASSERT_EQ(models.size(), 3u);
  for (const BuildingModel& model : models) {
    EXPECT_EQ(model.kind, model.id == "span" ? ModelKind::bridge : ModelKind::vegetation) << model.id;
    EXPECT_EQ(model.polygons.size(), model.id == "span" ? 2u : 1u) << model.id;
  }
  EXPECT_EQ(read(text, {.vegetation = false}).size(), 1u);
  EXPECT_EQ(read(text, {.bridges = false}).size(), 2u);
}

TEST(CityJson, EveryVersionsWayToNameCrsAndLevelIsRead) {
  const std::string objects = R"("CityObjects":{"b":{"type":"Building","geometry":[{"type":"Solid","lod":LOD,"boundaries":[[[[0,1,2,3]]]]}]}})";
  const auto text = [&](const std::string& version, const std::string& crs, const std::string& lod, const std::string& transform) {
    std::string with_lod = objects;
    with_lod.replace(with_lod.find("LOD"), 3, lod);
    return R"({"type":"CityJSON","version":")" + version + R"(","metadata":{"referenceSystem":")" + crs + "\"}" + transform + "," + with_lod + "," + vertices + "}";
  };
  const std::string transform = R"(,"transform":{"scale":[0.001,0.001,0.001],"translate":[0,0,0]})";
  for (const auto& [version, crs, lod, scaled] : {std::tuple("1.0", "urn:ogc:def:crs:EPSG::7415", "2", ""), {"1.0", "urn:ogc:def:crs:EPSG::7415", "2.2", transform.c_str()},
                                                  {"1.1", "https://www.opengis.net/def/crs/EPSG/0/7415", "\"2\"", transform.c_str()},
                                                  {"2.0", "https://www.opengis.net/def/crs/EPSG/0/7415", "\"2.2\"", transform.c_str()}}) {
    const auto models = read(text(version, crs, lod, scaled));
    ASSERT_EQ(models.size(), 1u) << version;
    EXPECT_EQ(models[0].srs_name, crs);
    EXPECT_EQ(models[0].lod, 2) << version;
    const double side = *scaled ? 1 : 1000;
    EXPECT_NEAR(polygon_area(models[0].polygons.at(0).polygon), side * side, 1e-6) << version;
  }
}

TEST(CityJson, APartyWallIsAFaceOfEachSolidThatItParts) {
  const auto wall_of = [](const std::string& type, const std::string& boundaries) {
    return read("{" + head + "," + vertices + R"(,"CityObjects":{"b":{"type":"Building","geometry":[{"type":")" + type + R"(","lod":"2","boundaries":)" + boundaries + "}]}}}")[0].polygons.size();
  };
  EXPECT_EQ(wall_of("CompositeSolid", "[[[[[0,1,2]]]],[[[[2,1,0]]]]]"), 2u);
  EXPECT_EQ(wall_of("Solid", "[[[[0,1,2]],[[2,1,0]]]]"), 1u);
}

TEST(CityJson, TheVoidInsideASolidIsNotSeen) {
  const auto models = read("{" + head + "," + vertices + R"(,"CityObjects":{"b":{"type":"Building","geometry":[{"type":"Solid","lod":"2","boundaries":[[[[0,1,2]]],[[[0,1,4]]]]}]}}})");
  ASSERT_EQ(models[0].polygons.size(), 1u);
  EXPECT_DOUBLE_EQ(models[0].polygons[0].polygon.exterior[2].z(), 100);
}

TEST(CityJson, AMirroredTemplateLooksOutwardStill) {
  const auto looks_up = [](const std::string& matrix) {
    return newell_normal(read("{" + head + "," + vertices + R"(,"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"3","boundaries":[[[0,1,2]]]}],
      "vertices-templates":[[0,0,0],[1,0,0],[0,1,0]]},"CityObjects":{"b":{"type":"Building","geometry":[{"type":"GeometryInstance","template":0,"boundaries":[1],
      "transformationMatrix":)" + matrix + "}]}}}")[0].polygons[0].polygon).z() > 0;
  };
  EXPECT_TRUE(looks_up("[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]"));
  EXPECT_TRUE(looks_up("[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]"));
}

TEST(CityJson, TemplatesArePlacedAndTinReliefIsTerrain) {
  const std::string text = "{" + head + "," + vertices + R"(,"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"3","boundaries":[[[0,1,2]]]}],
    "vertices-templates":[[0,0,0],[1,0,0],[0,1,0]]},"CityObjects":{
    "b":{"type":"Building","geometry":[{"type":"GeometryInstance","template":0,"boundaries":[1],"transformationMatrix":[2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1]}]},
    "t":{"type":"TINRelief","geometry":[{"type":"CompositeSurface","lod":"1","boundaries":[[[0,1,2]]]}]}}})";
  const auto models = read(text);
  ASSERT_EQ(models.size(), 2u);
  EXPECT_NEAR(polygon_area(models[0].polygons[0].polygon), 2.0, 1e-6);
  EXPECT_DOUBLE_EQ(models[0].polygons[0].polygon.exterior[0].x(), 500001.0);
  EXPECT_EQ(models[1].kind, ModelKind::terrain);
  EXPECT_EQ(models[1].polygons[0].surface_class, SurfaceClass::terrain);
}

TEST(CityJson, TemplatesPlacedBeyondWhatABuildingMayHoldAreRefused) {
  std::string ring = "0", instances;
  for (int i = 1; i < 40'000; ++i) ring += "," + std::to_string(i % 3);
  for (int i = 0; i < 250; ++i)
    instances += std::string(i ? "," : "") + R"({"type":"GeometryInstance","template":0,"boundaries":[1],"transformationMatrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})";
  const std::string text = "{" + head + "," + vertices + R"(,"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"3","boundaries":[[[)" + ring +
                           R"(]]]}],"vertices-templates":[[0,0,0],[1,0,0],[0,1,0]]},"CityObjects":{"b":{"type":"Building","geometry":[)" + instances + "]}}}";
  try {
    read(text);
    ADD_FAILURE() << "was read";
  } catch (const FormatError& error) {
    EXPECT_NE(std::string(error.what()).find("more than 8 million vertices"), std::string::npos) << error.what();
  }
  BuildingModelOptions coarser;   // as the message says
  coarser.lod = 2;
  EXPECT_EQ(read(text, coarser).size(), 1u);
}

TEST(CityJson, TemplatesOfLevelsThatAreNotChosenDoNotCountForTheFile) {
  const auto instance = [](int number) {
    return R"({"type":"GeometryInstance","template":)" + std::to_string(number) + R"(,"boundaries":[1],"transformationMatrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})";
  };
  std::string ring = "0", instances = instance(0), objects, parts;
  for (int i = 1; i < 200'000; ++i) ring += "," + std::to_string(i % 3);
  for (int i = 0; i < 35; ++i) instances += "," + instance(1);
  for (int i = 0; i < 6; ++i) objects += std::string(i ? "," : "") + "\"b" + std::to_string(i) + R"(":{"type":"Building","geometry":[)" + instances + "]}";   // 42 million vertices
  for (int i = 0; i < 6; ++i) parts += ",\"p" + std::to_string(i) + R"(":{"type":"BuildingPart","parents":["b)" + std::to_string(i) + R"("],"geometry":[]})";
  for (const std::string& members : {objects, objects + parts}) {   // buildings that are whole at once, and that wait for their parts
    const std::string text = "{" + head + "," + vertices + R"(,"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"3","boundaries":[[[0,1,2]]]},)"
        R"({"type":"MultiSurface","lod":"2","boundaries":[[[)" + ring + R"(]]]}],"vertices-templates":[[0,0,0],[1,0,0],[0,1,0]]},"CityObjects":{)" + members + "}}";
    EXPECT_EQ(read(text).size(), 6u);
  }
}

TEST(CityJson, ASequenceGivesEachFeatureItsOwnVertices) {
  const std::string header = R"({"type":"CityJSON","version":"2.0","CityObjects":{},"vertices":[],"transform":{"scale":[1,1,1],"translate":[10,20,30]}})";
  const std::string feature = R"({"type":"CityJSONFeature","id":"f","vertices":[[0,0,0],[1,0,0],[0,1,0]],"CityObjects":{"f":{"type":"Building",
    "geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}]}}})";
  std::string line = feature;
  std::erase(line, '\n');
  for (const std::string extension : {".city.jsonl", ".json"}) {   // by name or by content
    const auto models = read(header + "\n" + line + "\n" + line + "\n", {}, extension);
    ASSERT_EQ(models.size(), 2u);
    EXPECT_EQ(models[1].polygons[0].polygon.exterior[0], Eigen::Vector3d(10, 20, 30));
  }
}

TEST(CityJson, UnknownMinorVersionsAreReadAndUnknownMajorOnesRefused) {
  const auto message = [](const std::string& version) -> std::string {
    try {
      read(R"({"type":"CityJSON","version":)" + version + "," + vertices + R"(,"CityObjects":{"b":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}]}}})");
      return "";
    } catch (const FormatError& error) {
      return error.what();
    }
  };
  for (const std::string version : {R"("1.0")", R"("1.0.3")", R"("1.9")", R"("2.0")", R"("2.7")", "2"}) EXPECT_EQ(message(version), "") << version;
  for (const std::string version : {R"("9.0")", R"("0.9")", R"("20.1")", R"("3.0")", "null"}) EXPECT_NE(message(version).find("version"), std::string::npos) << version;
  EXPECT_NE(message(R"("9.0")").find("\"9.0\""), std::string::npos);
}

TEST(CityJson, BadInputIsRefusedWithItsCause) {
  auto message = [](const std::string& text) -> std::string {
    try {
      read(text);
      return "";
    } catch (const FormatError& error) {
      return error.what();
    }
  };
  const std::string object = R"("CityObjects":{"b":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,99]]]}]}})";
  EXPECT_NE(message("{" + head + "," + object + "," + vertices + "}").find("vertex that is not there"), std::string::npos);
  EXPECT_NE(message("{" + head + "," + object).find("no whole JSON"), std::string::npos);
  EXPECT_NE(message("{}").find("no CityJSON"), std::string::npos);
  EXPECT_NE(message(R"({"type":"FeatureCollection"})").find("CityJSON"), std::string::npos);
  EXPECT_NE(message(std::string(100000, '[')).find("nested deeper"), std::string::npos);
}

}  // namespace
}  // namespace priormap
