#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <priormap/tessellation/extrude.hpp>
#include <priormap/tessellation/sample.hpp>
#include <priormap/tessellation/triangulate.hpp>
#include <random>

namespace priormap {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points sampled(const Polygon3& face, double spacing_m) {
  Points points;
  FaceSampler(spacing_m).sample(face, points);
  return points;
}

double distance_to_nearest(const Points& points, const Eigen::Vector3d& p) {
  double nearest = 1e300;
  for (const Eigen::Vector3d& q : points) nearest = std::min(nearest, (p - q).norm());
  return nearest;
}

const Polygon3 tilted{{{0, 0, 5}, {8, 0, 5}, {8, 3, 9}, {4, 3, 9}, {4, 1.5, 7}, {0, 1.5, 7}}, {{{5, 0.75, 6}, {5, 1.5, 7}, {7, 1.5, 7}, {7, 0.75, 6}}}};

TEST(Sample, AWallIsARegularGridIncludingItsEdges) {
  const Points points = sampled(wall_face({0, 0}, {3, 0}, 10, 12).polygon, 0.5);
  EXPECT_EQ(points.size(), 7u * 5u);
  for (int i = 0; i <= 6; ++i)
    for (int j = 0; j <= 4; ++j) EXPECT_LT(distance_to_nearest(points, {0.5 * i, 0, 10 + 0.5 * j}), 1e-9);
}

TEST(Sample, WhatStandsAboveEachOtherOnAWallComesInARow) {
  const Points points = sampled(wall_face({1, 2}, {31, 14}, 10, 20).polygon, 0.5);
  std::size_t columns = 0;
  for (std::size_t i = 1; i < points.size(); ++i) columns += (points[i] - points[i - 1]).head<2>().norm() > 1e-9;
  EXPECT_LE(columns, 3u * 65u) << "the inside column by column, foot and top along the edge";
  EXPECT_GT(points.size(), 20u * 65u);
}

TEST(Sample, NoSpotIsFartherThanTheSpacing) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const double spacing_m : {0.2, 0.5, 0.7, 1.0}) {
    const Points points = sampled(tilted, spacing_m);
    const TriangleMesh mesh = triangulate(tilted);
    for (const auto& [a, b, c] : mesh.triangles)
      for (int i = 0; i < 200; ++i) {
        double s = unit(random), t = unit(random);
        if (s + t > 1) { s = 1 - s; t = 1 - t; }
        const Eigen::Vector3d spot = mesh.vertices[a] + s * (mesh.vertices[b] - mesh.vertices[a]) + t * (mesh.vertices[c] - mesh.vertices[a]);
        EXPECT_LT(distance_to_nearest(points, spot), spacing_m);
      }
  }
}

TEST(Sample, EveryPointLiesOnTheFace) {
  const TriangleMesh mesh = triangulate(tilted);
  for (const Eigen::Vector3d& p : sampled(tilted, 0.3)) {
    double nearest = 1e300;
    for (const auto& [ia, ib, ic] : mesh.triangles) {
      const Eigen::Vector3d &a = mesh.vertices[ia], &b = mesh.vertices[ib], &c = mesh.vertices[ic];
      const Eigen::Vector3d n = (b - a).cross(c - a);
      const double twice = n.squaredNorm();
      const double wa = n.dot((b - p).cross(c - p)) / twice, wb = n.dot((c - p).cross(a - p)) / twice, wc = n.dot((a - p).cross(b - p)) / twice;
      const double outside = std::max({0.0, -wa, -wb, -wc});
      nearest = std::min(nearest, outside + std::abs(n.normalized().dot(p - a)));
    }
    EXPECT_LT(nearest, 1e-9) << p.transpose();
  }
}

TEST(Sample, TheNormalPointsOutward) {
  Points points;
  const Eigen::Vector3d normal = FaceSampler(0.5).sample(tilted, points);
  EXPECT_TRUE(normal.isApprox(Eigen::Vector3d(0, -0.8, 0.6)));
  EXPECT_TRUE(FaceSampler(0.5).sample(Polygon3{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}}, points).isZero());
}

TEST(Sample, AMeshGivesThePointsOfItsFacesHoweverItIsTriangulated) {
  const auto sorted = [](Points points) {
    for (Eigen::Vector3d& p : points) p = (p * 1e6).array().round() / 1e6;
    std::ranges::sort(points, [](const auto& a, const auto& b) { return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end()); });
    return points;
  };
  Points points, normals;
  FaceSampler(0.5).sample(triangulate(tilted), points, normals);
  EXPECT_EQ(sorted(points), sorted(sampled(tilted, 0.5)));
  ASSERT_EQ(normals.size(), points.size());
  for (const Eigen::Vector3d& n : normals) EXPECT_TRUE(n.isApprox(Eigen::Vector3d(0, -0.8, 0.6)));
}

TEST(Sample, MovingAFaceMovesItsPoints) {
  Polygon3 moved = tilted;
  const Eigen::Vector3d shift(691234.5, 5334567.25, 512);
  for_each_ring(moved, [&](Ring3& ring) { for (Eigen::Vector3d& p : ring) p += shift; });
  const Points before = sampled(tilted, 0.5), after = sampled(moved, 0.5);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((before[i] + shift - after[i]).norm(), 1e-6);
}

TEST(Sample, AsACloudNearItsOrigin) {
  const Eigen::Vector3d origin(691000, 5334000, 500);
  const PointCloud cloud = sample(extrude(Polygon2{{{691010, 5334010}, {691020, 5334010}, {691020, 5334020}}, {}}, 500, 508)[1].mesh, 0.5, origin);
  ASSERT_FALSE(cloud.empty());
  ASSERT_EQ(cloud.normal.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_NEAR(cloud.position(i).z(), 508, 1e-4);
    EXPECT_EQ(cloud.normal[i], Eigen::Vector3f(0, 0, 1));
  }
}

}  // namespace
}  // namespace priormap
