#include "model_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "face_index.hpp"

namespace priormap {
namespace {

ModelPolygon polygon(Ring3 ring, int solid) {
  ModelPolygon stated;
  stated.polygon.exterior = std::move(ring);
  stated.solid = solid;
  return stated;
}
ModelPolygon turned(ModelPolygon stated) {
  std::ranges::reverse(stated.polygon.exterior);
  return stated;
}

/// The faces of a box, looking outward: bottom, top, then the walls to the south, east, north and west.
std::vector<ModelPolygon> box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int solid) {
  const auto at = [&](int x, int y, int z) { return Eigen::Vector3d(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z()); };
  return {polygon({at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)}, solid), polygon({at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)}, solid),
          polygon({at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)}, solid), polygon({at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)}, solid),
          polygon({at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1)}, solid), polygon({at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1)}, solid)};
}

BuildingModel model_of(std::vector<ModelPolygon> a, const std::vector<ModelPolygon>& b) {
  BuildingModel model;
  model.polygons = std::move(a);
  model.polygons.insert(model.polygons.end(), b.begin(), b.end());
  return model;
}

constexpr std::size_t east = 3, west = 5, number_of_faces = 6;

/// Two boxes side by side; the second has the first's wall as its own, as the file states it or turned.
BuildingModel two_boxes(bool turns) {
  BuildingModel model = model_of(box({0, 0, 0}, {10, 10, 5}, 1), box({10, 0, 0}, {20, 10, 5}, 2));
  ModelPolygon wall = model.polygons[east];
  if (turns) wall = turned(wall);
  wall.solid = 2;
  wall.repeated = !turns;
  wall.shared = model.polygons[east].shared = true;
  model.polygons[number_of_faces + west] = wall;
  return model;
}

/// As where the window in a wall stands beside the solid that has the wall with its hole: the hall is closed all the same, and what stands inside it is hidden.
TEST(ModelFaces, AFaceStatedBesideTheSolidThatItClosesBelongsToIt) {
  BuildingModel model = model_of(box({0, 0, 0}, {10, 10, 5}, 1), {});
  model.polygons[east].solid = 0;
  Diagnostics diagnostics;
  const std::vector<ModelFace> faces = model_faces(model, diagnostics);
  EXPECT_EQ(closed_solids(faces), (std::set<SolidKey>{{0, 1}}));
  EXPECT_EQ(faces[east].solid, faces[west].solid);
  model.polygons.erase(model.polygons.begin() + 1);   // without a top it is open with that face, too
  EXPECT_TRUE(closed_solids(model_faces(model, diagnostics)).empty());
}

/// A passage 10 m long, open at its western and eastern end, beside a box.
BuildingModel passage() {
  BuildingModel model = model_of(box({0, 0, 0}, {10, 4, 3}, 1), box({50, 0, 0}, {60, 4, 3}, 2));
  model.polygons.erase(model.polygons.begin() + west);
  model.polygons.erase(model.polygons.begin() + east);
  return model;
}

TEST(ModelFaces, ATubeThatIsOpenAtBothEndsEnclosesNothing) {
  Diagnostics diagnostics;
  BuildingModel model = passage();
  EXPECT_EQ(closed_solids(model_faces(model, diagnostics)), (std::set<SolidKey>{{0, 2}}));
  const std::vector<ModelPolygon> whole = box({0, 0, 0}, {10, 4, 3}, 0);
  model.polygons.push_back(whole[west]);
  model.polygons.push_back(whole[east]);   // stated beside the tube
  EXPECT_EQ(closed_solids(model_faces(model, diagnostics)), (std::set<SolidKey>{{0, 1}, {0, 2}}));
}

TEST(ModelFaces, AnOpenTubeLeavesAHouseOfItsPartWhatIsStatedBesideThem) {
  Diagnostics diagnostics;
  BuildingModel model = passage();
  constexpr std::size_t faces_of_tube = number_of_faces - 2;
  model.polygons[faces_of_tube + east].solid = 0;
  EXPECT_EQ(closed_solids(model_faces(model, diagnostics)), (std::set<SolidKey>{{0, 2}}));
}

TEST(ModelFaces, WhetherASolidIsClosedDoesNotDependOnHowFarItIsFromAnother) {
  Diagnostics diagnostics;
  const BuildingModel model = model_of(box({-2000, 0, 0}, {-1990, 4, 3}, 3), passage().polygons);
  EXPECT_EQ(closed_solids(model_faces(model, diagnostics)), (std::set<SolidKey>{{0, 2}, {0, 3}}));
}

TEST(ModelFaces, ASolidIsClosedThoughItsFacesMeetInOtherCorners) {
  // The eastern wall in two, the north with a window in the wall's hole.
  BuildingModel model = model_of(box({0, 0, 0}, {10, 10, 5}, 1), {});
  model.polygons[east].polygon.exterior = {{10, 0, 0}, {10, 4, 0}, {10, 4, 5}, {10, 0, 5}};
  model.polygons.push_back(polygon({{10, 4, 0}, {10, 10, 0}, {10, 10, 5}, {10, 4, 5}}, 1));
  model.polygons[4].polygon.holes = {{{3, 10, 2}, {3, 10, 3}, {4, 10, 3}, {4, 10, 2}}};
  model.polygons.push_back(polygon({{4, 10, 2}, {3, 10, 2}, {3, 10, 3}, {4, 10, 3}}, 1));
  Diagnostics diagnostics;
  EXPECT_EQ(closed_solids(model_faces(model, diagnostics)).size(), 1u);
  for (Ring3& hole : model.polygons[4].polygon.holes) std::ranges::reverse(hole);
  EXPECT_EQ(closed_solids(model_faces(model, diagnostics)).size(), 1u);
  model.polygons.pop_back();
  EXPECT_TRUE(closed_solids(model_faces(model, diagnostics)).empty());
}

TEST(ModelFaces, AWallThatTwoSolidsShareLooksOutOfEach) {
  for (const bool turns : {false, true}) {
    Diagnostics diagnostics;
    const std::vector<ModelFace> faces = model_faces(two_boxes(turns), diagnostics);
    EXPECT_DOUBLE_EQ(faces[east].normal.x(), 1);
    EXPECT_DOUBLE_EQ(faces[number_of_faces + west].normal.x(), -1);
    EXPECT_EQ(closed_solids(faces).size(), 2u);
    EXPECT_EQ(diagnostics.total(), 0u);
  }
}

TEST(ModelFaces, ASharedFaceOfAnOpenSolidStaysAsItIsStated) {
  // A roof without floor and walls below a canopy that shares a piece of it.
  BuildingModel model = model_of(box({0, 0, 0}, {20, 20, 5}, 1), box({0, 0, 4}, {3, 3, 5}, 2));
  model.polygons.erase(model.polygons.begin());
  ModelPolygon piece = model.polygons[5 + 1];
  piece.solid = 1;
  piece.shared = model.polygons[5 + 1].shared = true;
  model.polygons.push_back(piece);
  Diagnostics diagnostics;
  EXPECT_DOUBLE_EQ(model_faces(model, diagnostics).back().normal.z(), 1);
}

TEST(ModelFaces, ASolidThatLooksInwardIsTurnedAndNotTheOneBesideIt) {
  BuildingModel model = model_of(box({0, 0, 0}, {10, 10, 5}, 1), box({30, 0, 0}, {40, 10, 5}, 2));
  for (std::size_t i = 0; i < number_of_faces; ++i) model.polygons[i] = turned(model.polygons[i]);
  Diagnostics diagnostics;
  const std::vector<ModelFace> faces = model_faces(model, diagnostics);
  for (const std::size_t first : {std::size_t{0}, number_of_faces}) EXPECT_DOUBLE_EQ(faces[first + east].normal.x(), 1);
  EXPECT_EQ(diagnostics.counts().at(DiagnosticCode::polygon_wrong_orientation), 1u);
}

TEST(ModelFaces, AnOpenSolidLeavesTheOthersClosed) {
  BuildingModel model = model_of(box({0, 0, 0}, {10, 10, 5}, 1), box({30, 0, 0}, {40, 10, 5}, 2));
  model.polygons.pop_back();
  Diagnostics diagnostics;
  EXPECT_EQ(closed_solids(model_faces(model, diagnostics)), (std::set<SolidKey>{{0, 1}}));
}

std::size_t left_of(const FaceIndex& index, const ModelFace& face) {
  std::vector<Eigen::Vector3d> points;
  for (double y = 1; y < 9.5; ++y) points.emplace_back(face.polygon.exterior[0].x(), y, 0.5 * (face.polygon.exterior[0].z() + face.polygon.exterior[2].z()));
  std::vector<Eigen::Vector3d> normals(points.size(), face.normal);
  index.remove_hidden(0, face, points, normals);
  return points.size();
}

TEST(FaceIndex, AWallBetweenTwoSolidsOfABuildingIsHidden) {
  for (const bool turns : {false, true}) {
    Diagnostics diagnostics;
    const std::vector<ModelFace> faces = model_faces(two_boxes(turns), diagnostics);
    FaceIndex index;
    index.add(0, faces);
    index.finish();
    EXPECT_EQ(left_of(index, faces[east]), 0u);
    EXPECT_EQ(left_of(index, faces[number_of_faces + west]), 0u);
    EXPECT_EQ(left_of(index, faces[west]), 9u);
    EXPECT_EQ(left_of(index, faces[number_of_faces + east]), 9u);
  }
}

/// Of the eastern wall of a house, 5 m high, before the western one of another, 4 m high.
std::size_t left_across(double gap_m, double turned_by_m) {
  const std::vector<ModelPolygon> house = box({0, 0, 0}, {10, 10, 5}, 1);
  std::vector<ModelPolygon> other = box({10 + gap_m, 0, 0}, {20, 10, 4}, 1);
  for (ModelPolygon& face : other)
    for (Eigen::Vector3d& p : face.polygon.exterior)
      if (p.x() < 15 && p.y() > 5) p.x() += turned_by_m;
  Diagnostics diagnostics;
  const std::vector<ModelFace> faces = model_faces(model_of(house, {}), diagnostics);
  FaceIndex index;
  index.add(0, faces);
  index.add(1, model_faces(model_of(other, {}), diagnostics));
  index.finish();
  return left_of(index, faces[east]);
}

TEST(FaceIndex, WallsThatFaceEachOtherAcrossAJointAreOne) {
  EXPECT_EQ(left_across(0.04, 0), 0u);
  EXPECT_EQ(left_across(0.08, 0), 0u);
  EXPECT_EQ(left_across(0.12, 0), 9u);
  EXPECT_EQ(left_across(-0.1, 0.2), 0u);   // 1 degree
  EXPECT_GT(left_across(0.06, 1.2), 7u);   // 7 degrees
  EXPECT_EQ(left_across(-0.04, 1.2), 9u);   // as wide as a joint where the first spot is
}

TEST(FaceIndex, ARoofIsSeenThroughTheGapBelowWhatHangsOverIt) {
  Diagnostics diagnostics;
  const std::vector<ModelFace> faces = model_faces(model_of(box({0, 0, 0}, {10, 10, 5}, 1), {}), diagnostics);
  for (const double gap_m : {0.03, 0.08}) {
    FaceIndex index;
    index.add(0, faces);
    index.add(1, model_faces(model_of(box({0, 0, 5 + gap_m}, {10, 10, 8}, 1), {}), diagnostics));
    index.finish();
    EXPECT_EQ(left_of(index, faces[1]), gap_m < 0.05 ? 0u : 9u);
  }
}

TEST(FaceIndex, SolidsThatHaveAFaceInCommonHaveNoJointBetweenThem) {
  for (const bool has_common_face : {false, true}) {
    BuildingModel model = model_of(box({0, 0, 0}, {10, 10, 5}, 1), box({10.08, 0, 0}, {20, 10, 5}, 2));
    if (has_common_face) {
      ModelPolygon upper = polygon({{10, 0, 6}, {10, 10, 6}, {10, 10, 8}, {10, 0, 8}}, 1);
      model.polygons.push_back(upper);
      upper.solid = 2;
      upper.repeated = true;
      model.polygons.push_back(upper);
    }
    Diagnostics diagnostics;
    const std::vector<ModelFace> faces = model_faces(model, diagnostics);
    FaceIndex index;
    index.add(0, faces);
    index.finish();
    EXPECT_EQ(left_of(index, faces[east]), has_common_face ? 9u : 0u);
  }
}

TEST(FaceIndex, WhatStandsInAPassageIsSeen) {
  Diagnostics diagnostics;
  const std::vector<ModelFace> kiosk = model_faces(model_of(box({4, 1, 0}, {6, 3, 2.5}, 1), {}), diagnostics);
  FaceIndex index;
  index.add(0, kiosk);
  index.add(1, model_faces(passage(), diagnostics));
  index.finish();
  std::vector<Eigen::Vector3d> points{{6, 2, 1}}, normals{kiosk[east].normal};
  index.remove_hidden(0, kiosk[east], points, normals);
  EXPECT_EQ(points.size(), 1u);
}

TEST(FaceIndex, ASheetIsNotHiddenByItsOtherSideThoughTheBodyStatesThatToo) {
  // A fence of 3 cm, a part of its own; the body, which is no solid, names its eastern side.
  BuildingModel model = model_of(box({0, 0, 0}, {0.03, 10, 5}, 0), {});
  for (ModelPolygon& stated : model.polygons) stated.part = 1;
  ModelPolygon named = model.polygons[east];
  named.part = 0;
  model.polygons[east].repeated = true;
  model.polygons.insert(model.polygons.begin(), named);
  Diagnostics diagnostics;
  const std::vector<ModelFace> faces = model_faces(model, diagnostics);
  FaceIndex index;
  index.add(0, faces);
  index.finish();
  EXPECT_EQ(left_of(index, faces[0]), 9u);
  EXPECT_EQ(left_of(index, faces[1 + west]), 9u);
}

}  // namespace
}  // namespace priormap
