#include <gtest/gtest.h>

#include <priormap/tessellation/normalize.hpp>
#include <random>

#include "total_area.hpp"

namespace priormap {
namespace {

void expect_oriented(const std::vector<Polygon2>& polygons) {
  for (const Polygon2& polygon : polygons) {
    EXPECT_GT(signed_area(polygon.exterior), 0);
    for (const Ring2& hole : polygon.holes) EXPECT_LT(signed_area(hole), 0);
  }
}

const Ring2 square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};

struct Normalized {
  explicit Normalized(const std::vector<Ring2>& rings) : polygons(normalize(rings, "way/1", diagnostics)) { expect_oriented(polygons); }
  Diagnostics diagnostics;
  std::vector<Polygon2> polygons;
  std::size_t count(DiagnosticCode code) const { return diagnostics.counts().contains(code) ? diagnostics.counts().at(code) : 0; }
};

TEST(Normalize, TurnsAClockwiseRing) {
  const Normalized result({Ring2(square.rbegin(), square.rend())});
  ASSERT_EQ(result.polygons.size(), 1u);
  EXPECT_DOUBLE_EQ(total_area(result.polygons), 100);
  EXPECT_EQ(result.diagnostics.total(), 0u);
}

TEST(Normalize, TheClosingPointIsNoDefectButARepeatedOneIs) {
  Ring2 closed = square;
  closed.push_back(square.front());
  EXPECT_EQ(Normalized({closed}).diagnostics.total(), 0u);
  closed.insert(closed.begin() + 1, closed[0]);
  const Normalized repeated({closed});
  EXPECT_EQ(repeated.count(DiagnosticCode::consecutive_points_same), 1u);
  EXPECT_EQ(repeated.polygons[0].exterior.size(), 4u);
}

TEST(Normalize, HolesAreFoundWhateverTheOrderOfRings) {
  const Ring2 hole{{2, 2}, {4, 2}, {4, 4}, {2, 4}};
  for (const auto& rings : {std::vector<Ring2>{square, hole}, std::vector<Ring2>{hole, square}}) {
    const Normalized result(rings);
    ASSERT_EQ(result.polygons.size(), 1u);
    EXPECT_EQ(result.polygons[0].holes.size(), 1u);
    EXPECT_DOUBLE_EQ(total_area(result.polygons), 96);
    EXPECT_EQ(result.diagnostics.total(), 0u);
  }
}

TEST(Normalize, AnIslandInAHoleIsASecondPolygon) {
  const Normalized result({square, {{1, 1}, {9, 1}, {9, 9}, {1, 9}}, {{4, 4}, {6, 4}, {6, 6}, {4, 6}}});
  EXPECT_EQ(result.polygons.size(), 2u);
  EXPECT_DOUBLE_EQ(total_area(result.polygons), 100 - 64 + 4);
}

TEST(Normalize, HolesThatShareAnEdgeMelt) {
  const Normalized result({square, {{2, 2}, {4, 2}, {4, 6}, {2, 6}}, {{4, 2}, {6, 2}, {6, 6}, {4, 6}}});
  ASSERT_EQ(result.polygons.size(), 1u);
  EXPECT_EQ(result.polygons[0].holes.size(), 1u);
  EXPECT_DOUBLE_EQ(total_area(result.polygons), 100 - 16);
}

TEST(Normalize, AHoleThatSharesPartOfTheOuterEdgeIsANotch) {
  const Normalized result({square, {{4, 0}, {6, 0}, {6, 3}, {4, 3}}});
  ASSERT_EQ(result.polygons.size(), 1u);
  EXPECT_TRUE(result.polygons[0].holes.empty());
  EXPECT_DOUBLE_EQ(total_area(result.polygons), 94);
}

TEST(Normalize, AHoleTouchingTheOuterRingAtAPointStaysAHole) {
  const Normalized result({square, {{5, 0}, {7, 3}, {3, 3}}});
  ASSERT_EQ(result.polygons.size(), 1u);
  EXPECT_EQ(result.polygons[0].holes.size(), 1u);
  EXPECT_DOUBLE_EQ(total_area(result.polygons), 94);
}

TEST(Normalize, ABowTieBecomesTwoTriangles) {
  const Normalized result({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}});
  EXPECT_EQ(result.count(DiagnosticCode::ring_self_intersection), 1u);
  EXPECT_EQ(result.polygons.size(), 2u);
  EXPECT_NEAR(total_area(result.polygons), 50, 1e-9);
}

TEST(Normalize, CrossingRingsAreCounted) {
  const Normalized result({square, {{5, 5}, {15, 5}, {15, 8}, {5, 8}}});
  EXPECT_EQ(result.count(DiagnosticCode::intersection_rings), 1u);
  EXPECT_NEAR(total_area(result.polygons), 100 - 15 + 15, 1e-9);
}

TEST(Normalize, ASpikeVanishes) {
  const Normalized result({{{0, 0}, {5, 0}, {5, -8}, {5, 0}, {10, 0}, {10, 10}, {0, 10}}});
  ASSERT_EQ(result.polygons.size(), 1u);
  EXPECT_NEAR(total_area(result.polygons), 100, 1e-9);
  for (const Eigen::Vector2d& p : result.polygons[0].exterior) EXPECT_GE(p.y(), 0);
}

TEST(Normalize, NothingIsLeftOfALineOrAPoint) {
  EXPECT_EQ(Normalized({{{0, 0}, {5, 5}, {0, 0}}}).count(DiagnosticCode::too_few_points), 1u);
  EXPECT_EQ(Normalized({{{0, 0}, {5, 5}, {10, 10}}}).count(DiagnosticCode::degenerate_geometry), 1u);
  EXPECT_TRUE(Normalized({{{0, 0}, {5, 5}, {10, 10}}}).polygons.empty());
}

TEST(Normalize, ARingGivenTwiceCountsOnce) {
  const Normalized result({square, {{10, 10}, {10, 0}, {0, 0}, {0, 10}}});
  EXPECT_EQ(result.count(DiagnosticCode::duplicated_rings), 1u);
  EXPECT_DOUBLE_EQ(total_area(result.polygons), 100);
}

/// Even-odd inside by ray casting over the raw rings is the oracle.
TEST(Normalize, KeepsTheEvenOddInsideOfRandomRings) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(0, 20);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Ring2> rings(1 + trial % 3);
    for (Ring2& ring : rings)
      for (int i = 0; i < 3 + trial % 6; ++i) ring.emplace_back(coordinate(random), coordinate(random));
    const Normalized result(rings);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d p(coordinate(random), coordinate(random));
      bool expected = false, inside = false;
      for (const Ring2& ring : rings) expected ^= contains(ring, p);
      for (const Polygon2& polygon : result.polygons) inside ^= contains(polygon, p);
      EXPECT_EQ(inside, expected) << "trial " << trial << " at " << p.transpose();
    }
  }
}

}  // namespace
}  // namespace priormap
