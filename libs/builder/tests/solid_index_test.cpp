#include <gtest/gtest.h>

#include <priormap/builder/solid_index.hpp>
#include <priormap/tessellation/sample.hpp>

namespace priormap {
namespace {

using Points = std::vector<Eigen::Vector3d>;

BuildingSolid block(double west, double south, double east, double north, double base_z, double top_z, bool on_ground = true) {
  BuildingSolid solid;
  solid.outline = {{{west, south}, {east, south}, {east, north}, {west, north}}, {}};
  solid.base_z = base_z;
  solid.eaves_z = solid.top_z = top_z;
  solid.on_ground = on_ground;
  solid.bounds = {west, south, east, north};
  return solid;
}

/// What stays of the points of one solid.
Points visible_points(const std::vector<BuildingSolid>& solids, std::uint32_t which, SurfaceClass surface_class) {
  const SolidIndex index(solids);
  const auto neighbors = index.near(which);
  FaceSampler sampler(0.5);
  Points all;
  for (const Face& face : solids[which].faces(true)) {
    if (face.surface_class != surface_class) continue;
    Points points;
    const Eigen::Vector3d normal = sampler.sample(face.polygon, points);
    index.remove_hidden(face, normal, neighbors, points);
    all.insert(all.end(), points.begin(), points.end());
  }
  return all;
}

std::size_t count(const Points& points, const std::function<bool(const Eigen::Vector3d&)>& where) {
  return static_cast<std::size_t>(std::ranges::count_if(points, where));
}

/// Inside the shared wall, away from the corners that other walls own too.
bool on_shared_wall(const Eigen::Vector3d& p) { return std::abs(p.x() - 10) < 1e-6 && p.y() > 0.1 && p.y() < 9.9; }

TEST(SolidIndex, OfASharedWallOnlyTheUpperStripStays) {
  const std::vector<BuildingSolid> solids{block(0, 0, 10, 10, 0, 12), block(10, 0, 20, 10, 0, 8)};
  const Points high = visible_points(solids, 0, SurfaceClass::wall), low = visible_points(solids, 1, SurfaceClass::wall);
  EXPECT_EQ(count(low, on_shared_wall), 0u);
  EXPECT_EQ(count(high, [](const auto& p) { return on_shared_wall(p) && p.z() <= 8; }), 0u);
  EXPECT_EQ(count(high, [](const auto& p) { return on_shared_wall(p) && p.z() > 8; }), 19u * 8u) << "every half metre above 8 m, up to 12 m";
  EXPECT_EQ(count(high, [](const auto& p) { return p.x() == 0; }), 21u * 25u + 2u * 25u) << "the far wall is whole; its corners belong to its neighbours too";
}

TEST(SolidIndex, EqualHeightsLeaveNothingOfTheSharedWall) {
  const std::vector<BuildingSolid> solids{block(0, 0, 10, 10, 0, 8), block(10, 0, 20, 10, 0, 8)};
  for (const std::uint32_t which : {0u, 1u}) EXPECT_EQ(count(visible_points(solids, which, SurfaceClass::wall), on_shared_wall), 0u);
}

TEST(SolidIndex, APartlySharedWallStaysBesideTheNeighbor) {
  const std::vector<BuildingSolid> solids{block(0, 0, 10, 10, 0, 8), block(10, 0, 20, 4, 0, 8)};
  const Points points = visible_points(solids, 0, SurfaceClass::wall);
  EXPECT_EQ(count(points, [](const auto& p) { return on_shared_wall(p) && p.y() < 3.9; }), 0u);
  EXPECT_EQ(count(points, [](const auto& p) { return on_shared_wall(p) && p.y() > 4.1; }), 11u * 17u);
}

TEST(SolidIndex, SlopingGroundHidesTheFootOfASharedWall) {
  const std::vector<BuildingSolid> solids{block(0, 0, 10, 10, -3, 8), block(10, 0, 20, 10, 0, 8)};
  EXPECT_EQ(count(visible_points(solids, 0, SurfaceClass::wall), on_shared_wall), 0u) << "below the neighbour is earth";
}

TEST(SolidIndex, APassageStaysOpen) {
  const std::vector<BuildingSolid> solids{block(0, 0, 10, 10, 0, 12), block(10, 0, 20, 10, 4, 12, false)};
  const Points points = visible_points(solids, 0, SurfaceClass::wall);
  EXPECT_GT(count(points, [](const auto& p) { return on_shared_wall(p) && p.z() < 3.9; }), 0u);
  EXPECT_EQ(count(points, [](const auto& p) { return on_shared_wall(p) && p.z() > 4.1; }), 0u);
}

TEST(SolidIndex, ATowerCoversTheRoofItStandsOn) {
  const std::vector<BuildingSolid> solids{block(0, 0, 20, 20, 0, 8), block(5, 5, 10, 10, 8, 20, false)};
  const Points roof = visible_points(solids, 0, SurfaceClass::roof);
  EXPECT_EQ(count(roof, [](const auto& p) { return p.x() > 5.1 && p.x() < 9.9 && p.y() > 5.1 && p.y() < 9.9; }), 0u);
  EXPECT_GT(count(roof, [](const auto& p) { return p.x() > 10.2; }), 0u);
}

TEST(SolidIndex, WallsInsideAnotherBlockAreGone) {
  const std::vector<BuildingSolid> solids{block(0, 0, 20, 20, 0, 8), block(5, 5, 10, 10, 0, 20)};
  const Points walls = visible_points(solids, 1, SurfaceClass::wall);
  EXPECT_EQ(count(walls, [](const auto& p) { return p.z() <= 8; }), 0u);
  EXPECT_GT(walls.size(), 0u);
}

TEST(SolidIndex, WallsThatFaceEachOtherAcrossAJointAreOne) {
  const auto left_and_right = [](double gap) {
    const std::vector<BuildingSolid> solids{block(0, 0, 10, 10, 0, 12), block(10 + gap, 0, 20, 10, 0, 8)};
    const auto on_other = [gap](const Eigen::Vector3d& p) { return std::abs(p.x() - 10 - gap) < 1e-6 && p.y() > 0.1 && p.y() < 9.9; };
    const Points left = visible_points(solids, 0, SurfaceClass::wall);
    EXPECT_EQ(count(left, [](const auto& p) { return on_shared_wall(p) && p.z() > 8; }), 19u * 8u) << gap;
    return std::pair(count(left, [](const auto& p) { return on_shared_wall(p) && p.z() <= 8; }), count(visible_points(solids, 1, SurfaceClass::wall), on_other));
  };
  for (const double gap : {0.0, 0.01, 0.049, 0.05, 0.051, 0.07, 0.09}) EXPECT_EQ(left_and_right(gap), std::pair(std::size_t{0}, std::size_t{0})) << gap;
  for (const double gap : {0.11, 0.2}) EXPECT_EQ(left_and_right(gap), std::pair(std::size_t{19 * 17}, std::size_t{19 * 17})) << gap;
}

TEST(SolidIndex, ACornerBeforeAWallHidesNothing) {
  std::vector<BuildingSolid> solids{block(0, 0, 10, 10, 0, 8), block(10.07, 0, 20, 10, 0, 8)};
  solids[1].outline = {{{10.07, 5}, {15, 0}, {20, 5}, {15, 10}}, {}};
  EXPECT_EQ(visible_points(solids, 0, SurfaceClass::wall).size(), visible_points({solids[0]}, 0, SurfaceClass::wall).size());
}

TEST(SolidIndex, ALaneBetweenHousesIsSeen) {
  const std::vector<BuildingSolid> solids{block(0, 0, 10, 10, 0, 8), block(10.5, 0, 20, 10, 0, 8)};
  EXPECT_EQ(visible_points(solids, 0, SurfaceClass::wall).size(), visible_points({solids[0]}, 0, SurfaceClass::wall).size());
}

TEST(SolidIndex, AGableOverALowerRoofStays) {
  std::vector<BuildingSolid> solids{block(0, 0, 10, 8, 0, 12), block(10, 0, 20, 8, 0, 9)};
  solids[0].eaves_z = 9;
  solids[0].roof = make_roof(solids[0].outline, 9, {RoofShape::gabled, 3});
  const Points walls = visible_points(solids, 0, SurfaceClass::wall);
  EXPECT_GT(count(walls, [](const auto& p) { return on_shared_wall(p) && p.z() > 9.1; }), 0u);
  EXPECT_EQ(count(walls, [](const auto& p) { return on_shared_wall(p) && p.y() < 7.9 && p.z() < 8.9; }), 0u);
}

}  // namespace
}  // namespace priormap
