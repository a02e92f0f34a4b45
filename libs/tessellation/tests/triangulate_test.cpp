#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <priormap/tessellation/triangulate.hpp>
#include <random>

namespace priormap {
namespace {

TEST(Triangulate, AreasOfTheTrianglesAddUpToThePolygons) {
  const std::vector<Polygon2> polygons{
      {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {}},
      {{{0, 0}, {10, 0}, {4, 3}, {0, 10}}, {}},  // not convex
      {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{2, 2}, {2, 4}, {4, 4}, {4, 2}}, {{6, 6}, {6, 8}, {8, 8}, {8, 6}}}},
      {{{0, 0}, {4, 0}, {4, 4}, {8, 4}, {8, 0}, {12, 0}, {12, 8}, {0, 8}}, {}},
      {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{5, 0}, {3, 3}, {7, 3}}}},  // the hole touches the edge
      {{{0, 0}, {5, 0}, {10, 0}, {10, 10}, {0, 10}}, {}},                  // three in a line
  };
  for (const Polygon2& polygon : polygons) {
    const TriangleMesh mesh = triangulate(polygon);
    EXPECT_NEAR(area(mesh), area(polygon), 1e-9);
    for (const auto& [a, b, c] : mesh.triangles)
      EXPECT_GT((mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).z(), 0);
  }
}

TEST(Triangulate, RandomStarsAtUtmCoordinates) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> radius(1, 40);
  for (int trial = 0; trial < 200; ++trial) {
    Polygon2 star;
    const int n = 3 + trial % 40;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * i / n, r = radius(random);
      star.exterior.emplace_back(691234 + r * std::cos(angle), 5334567 + r * std::sin(angle));
    }
    if (signed_area(star.exterior) < 1) continue;
    const TriangleMesh mesh = triangulate(star);
    EXPECT_NEAR(area(mesh), area(star), 1e-6 * area(star));
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(n - 2));
  }
}

TEST(Triangulate, ACrossingRingFollowsTheEvenOddRule) {
  EXPECT_NEAR(area(triangulate(Polygon2{{{0, 0}, {10, 10}, {10, 0}, {0, 10}}, {}})), 50, 1e-9);
}

TEST(Triangulate, InItsOwnPlaneWithItsOwnVertices) {
  const Polygon3 roof{{{0, 0, 5}, {8, 0, 5}, {8, 3, 9}, {0, 3, 9}}, {{{2, 0.75, 6}, {2, 1.5, 7}, {4, 1.5, 7}, {4, 0.75, 6}}}};
  double deviation = -1;
  const TriangleMesh mesh = triangulate(roof, &deviation);
  EXPECT_NEAR(deviation, 0, 1e-12);
  EXPECT_NEAR(area(mesh), 8 * 5 - 2 * 1.25, 1e-9);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  for (const auto& [a, b, c] : mesh.triangles)
    EXPECT_GT((mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).z(), 0);
}

TEST(Triangulate, TellsHowFarAPolygonIsFromPlanar) {
  double deviation = 0;
  const TriangleMesh mesh = triangulate(Polygon3{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0.4}, {0, 4, 0}}, {}}, &deviation);
  EXPECT_NEAR(deviation, 0.1, 0.01);
  EXPECT_EQ(mesh.vertices[2].z(), 0.4);
}

TEST(Triangulate, NothingFromAPolygonWithoutArea) {
  EXPECT_TRUE(triangulate(Polygon3{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {}}).triangles.empty());
  EXPECT_TRUE(triangulate(Polygon2{{{0, 0}, {1, 1}}, {}}).triangles.empty());
}

}  // namespace
}  // namespace priormap
