#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <priormap/builder/line_of_sight.hpp>
#include <priormap/tessellation/extrude.hpp>
#include <priormap/tessellation/sample.hpp>
#include <priormap/tessellation/triangulate.hpp>
#include <random>

namespace priormap {
namespace {

constexpr double east = 690000, north = 5340000;

struct Box {
  Eigen::Vector3d low, high;

  Polygon2 outline() const { return {{low.head<2>(), {high.x(), low.y()}, high.head<2>(), {low.x(), high.y()}}, {}}; }
  std::vector<Face> faces() const { return block_faces(outline(), low.z(), high.z(), true); }

  /// Slab test, independent of triangles and trees.
  bool blocks(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    const Eigen::Array3d way = to - from, a = (low - from).array() / way, b = (high - from).array() / way;
    return std::max(0.0, a.min(b).maxCoeff()) < std::min(1.0, a.max(b).minCoeff());
  }
};

Box box(double x, double y, double width, double depth, double height) { return {{east + x, north + y, 0}, {east + x + width, north + y + depth, height}}; }

FacePoints points_of(const Box& box) {
  FacePoints result;
  FaceSampler sampler(0.5);
  std::uint32_t number = 0;
  for (const Face& face : box.faces()) {
    const Eigen::Vector3d normal = sampler.sample(face.polygon, result.points);
    result.normals.resize(result.points.size(), normal);
    result.faces.resize(result.points.size(), number++);
  }
  return result;
}

LineOfSight sight_of(const std::vector<Box>& boxes, const std::vector<Eigen::Vector3d>& viewpoints, double range_m = 100) {
  TriangleMesh mesh;
  for (const Box& box : boxes)
    for (const Face& face : box.faces()) mesh.append(triangulate(face.polygon));
  return LineOfSight(viewpoints, mesh, range_m);
}

/// Share of the seen among the points that `choose` takes.
template <class Choose>
double seen_share(const LineOfSight& sight, const Box& box, const Choose& choose, LineOfSight::Skin skin = LineOfSight::Skin::closed) {
  const FacePoints points = points_of(box);
  const std::vector<bool> seen = sight.seen(points, skin);
  std::size_t chosen = 0, of_these = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector3d local = points.points[i] - Eigen::Vector3d(east, north, 0);
    if (!choose(local, points.normals[i])) continue;
    ++chosen;
    of_these += seen[i];
  }
  EXPECT_GT(chosen, 0u);
  return static_cast<double>(of_these) / static_cast<double>(chosen);
}

const Eigen::Vector3d road(east + 5, north - 10, 1.8);

TEST(LineOfSight, TheFrontOfAHouseIsSeenItsBackAndItsFlatRoofAreNot) {
  const Box house = box(0, 0, 10, 10, 8);
  const LineOfSight sight = sight_of({house}, {road});
  EXPECT_EQ(seen_share(sight, house, [](const auto&, const auto& normal) { return normal.y() < -0.5; }), 1);
  EXPECT_EQ(seen_share(sight, house, [](const auto& p, const auto&) { return p.y() > 2.5; }), 0);
  EXPECT_EQ(seen_share(sight, house, [](const auto& p, const auto& normal) { return normal.z() > 0.5 && p.y() < 1; }), 1) << "the roof's edge neighbours the front";
}

TEST(LineOfSight, ARoofOfUnknownShapeIsJudgedAsIfItRose) {
  const Box house = box(0, 0, 10, 10, 8);
  const auto roof = [](double from, double to) { return [=](const auto& p, const auto& normal) { return normal.z() > 0.5 && p.y() > from && p.y() < to; }; };
  // Over the eaves, 6.2 m above the sensor and 10 m away, the line of sight climbs 0.62 m a metre: 2 m above the roof 3.2 m in.
  const LineOfSight sight = sight_of({house}, {road});
  EXPECT_EQ(seen_share(sight, house, roof(0, 3), LineOfSight::Skin::may_rise), 1);
  EXPECT_EQ(seen_share(sight, house, roof(5.5, 9), LineOfSight::Skin::may_rise), 0);
  EXPECT_EQ(seen_share(sight_of({house}, {{east + 5, north - 80, 1.8}}), house, roof(0, 10), LineOfSight::Skin::may_rise), 1) << "from afar all of it";
}

TEST(LineOfSight, BehindABlockOnlyTheTopOfATallerOneIsSeen) {
  const Box block = box(-100, 0, 200, 5, 6), tower = box(0, 20, 10, 10, 30);
  const LineOfSight sight = sight_of({block, tower}, {road});
  // From 1.8 m over the 6 m edge at a distance of 10 m (front) to 15 m (back) the tower's front, 30 m away, is free above 14.4 m.
  const double horizon = 1.8 + (6 - 1.8) * 30 / 10;
  const auto front = [](const auto& normal) { return normal.y() < -0.5; };
  EXPECT_EQ(seen_share(sight, tower, [&](const auto& p, const auto& normal) { return front(normal) && p.z() > horizon; }), 1);
  EXPECT_EQ(seen_share(sight, tower, [&](const auto& p, const auto& normal) { return front(normal) && p.z() < horizon - 3; }), 0);
}

TEST(LineOfSight, EndsAtTheRange) {
  const Box house = box(0, 0, 10, 10, 8);
  EXPECT_EQ(seen_share(sight_of({house}, {road}, 9), house, [](const auto&, const auto&) { return true; }), 0);
  EXPECT_GT(seen_share(sight_of({house}, {road}, 12), house, [](const auto&, const auto&) { return true; }), 0);
}

TEST(LineOfSight, WhereTheGroundIsUnknownEverythingInRangeStays) {
  const Box house = box(0, 0, 10, 10, 8);
  const LineOfSight sight = sight_of({house}, {{road.x(), road.y(), std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_EQ(seen_share(sight, house, [](const auto&, const auto&) { return true; }), 1);
}

TEST(LineOfSight, ACanopyIsSeenFromBelow) {
  const Box canopy = box(0, 0, 10, 10, 4);   // hides nothing: it is no occluder
  const LineOfSight sight = sight_of({}, {road});
  EXPECT_EQ(seen_share(sight, canopy, [](const auto&, const auto& normal) { return normal.z() > 0.5; }, LineOfSight::Skin::open), 1);
}

TEST(LineOfSight, NothingThatARayReachesIsLost) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  std::vector<Box> town;
  for (int i = 0; i < 60; ++i) town.push_back(box(20 * (i % 10) + between(0, 6), 20 * (i / 10) + between(0, 6), between(4, 13), between(4, 13), between(3, 20)));
  std::vector<Eigen::Vector3d> viewpoints;
  for (double x = -10; x < 210; x += 2) viewpoints.emplace_back(east + x, north - 5 + 0.3 * x, 1.8);
  std::erase_if(viewpoints, [&](const auto& p) { return std::ranges::any_of(town, [&](const Box& b) { return b.blocks(p, p + Eigen::Vector3d(1e-3, 1e-3, 1e-3)); }); });
  const LineOfSight sight = sight_of(town, viewpoints);

  std::size_t reached = 0, lost = 0, hidden = 0, dropped = 0;
  for (const Box& house : town) {
    const FacePoints points = points_of(house);
    const std::vector<bool> seen = sight.seen(points, LineOfSight::Skin::closed);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Eigen::Vector3d from = points.points[i] + 0.1 * points.normals[i];
      const bool free = std::ranges::any_of(viewpoints, [&](const Eigen::Vector3d& v) {
        return (v - from).norm() < 100 && points.normals[i].dot(v - from) > 0 && std::ranges::none_of(town, [&](const Box& b) { return b.blocks(from, v); });
      });
      reached += free;
      lost += free && !seen[i];
      hidden += !free;
      dropped += !seen[i];
    }
  }
  EXPECT_LT(static_cast<double>(lost), 0.002 * static_cast<double>(reached)) << lost << " of " << reached;
  EXPECT_GT(static_cast<double>(dropped), 0.5 * static_cast<double>(hidden)) << dropped << " of " << hidden;
  EXPECT_LE(dropped - lost, hidden);
}

}  // namespace
}  // namespace priormap
