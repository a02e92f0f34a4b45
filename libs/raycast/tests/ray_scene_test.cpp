#include <priormap/raycast/ray_scene.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace priormap {
namespace {

const Eigen::Vector3d utm_origin{640000, 5400000, 500};

/// Axis-aligned box with outward triangles.
TriangleMesh box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back(corner & 1 ? max.x() : min.x(), corner & 2 ? max.y() : min.y(), corner & 4 ? max.z() : min.z());
  const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

/// Slab test (Kay and Kajiya 1986): distance to a box in front of the origin, infinite when missed.
double slab_range(const Eigen::Vector3d& direction, const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  double enter = -INFINITY, leave = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = min[axis] / direction[axis], b = max[axis] / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave && enter > 0 ? enter : INFINITY;
}

TEST(RayScene, HitsABoxWhereTheSlabTestSays) {
  const Eigen::Vector3d min(10, -4, -2), max(14, 5, 6);
  const std::vector<TriangleMesh> meshes{box(utm_origin + min, utm_origin + max)};
  const RayScene scene(meshes, utm_origin);
  std::vector<Ray> rays;
  for (int i = 0; i < 1003; ++i) {   // not a multiple of the packet size
    const double azimuth = -1.0 + 0.002 * i, elevation = 0.6 * std::sin(0.37 * i);
    rays.push_back({Eigen::Vector3f::Zero(), Eigen::Vector3f(std::cos(elevation) * std::cos(azimuth),
                                                             std::cos(elevation) * std::sin(azimuth), std::sin(elevation))});
  }
  std::vector<RayHit> hits(rays.size());
  scene.cast(rays, 100, hits);
  int num_hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double expected = slab_range(rays[i].direction.cast<double>(), min, max);
    ASSERT_EQ(hits[i].hit(), std::isfinite(expected)) << i;
    if (!hits[i].hit()) continue;
    ++num_hits;
    EXPECT_NEAR(hits[i].range_m, expected, 1e-4) << i;
    EXPECT_LT(hits[i].normal.dot(rays[i].direction), 0) << "outward triangles face the sensor";
  }
  EXPECT_GT(num_hits, 100);
}

TEST(RayScene, NearestMeshWinsAndRangeIsLimited) {
  const std::vector<TriangleMesh> meshes{box({20, -1, -1}, {21, 1, 1}), {}, box({10, -1, -1}, {11, 1, 1})};
  const RayScene scene(meshes, Eigen::Vector3d::Zero());
  const std::vector<Ray> rays{{Eigen::Vector3f(0, 0.1f, 0.2f), Eigen::Vector3f::UnitX()},
                              {Eigen::Vector3f(15, 0.1f, 0.2f), Eigen::Vector3f::UnitX()}};
  std::vector<RayHit> hits(2);
  scene.cast(rays, 100, hits);
  EXPECT_EQ(hits[0].mesh, 2u);
  EXPECT_NEAR(hits[0].range_m, 10, 1e-5);
  EXPECT_EQ(hits[1].mesh, 0u);
  EXPECT_NEAR(hits[1].range_m, 5, 1e-5);
  scene.cast(rays, 9, hits);
  EXPECT_FALSE(hits[0].hit());
  EXPECT_TRUE(hits[1].hit());
}

TEST(RayScene, ASegmentIsBlockedWhereTheRayAlongItHitsBeforeItsEnd) {
  const Eigen::Vector3d min(10, -4, -2), max(14, 5, 6);
  const std::vector<TriangleMesh> meshes{box(utm_origin + min, utm_origin + max)};
  const RayScene scene(meshes, utm_origin);
  std::vector<Segment> segments;
  std::vector<std::uint8_t> expected;
  for (int i = 0; i < 501; ++i) {
    const double azimuth = -1.0 + 0.004 * i, length = 8 + 0.02 * i;
    const Eigen::Vector3d direction(std::cos(azimuth), std::sin(azimuth), 0);
    segments.push_back({Eigen::Vector3f::Zero(), (length * direction).cast<float>()});
    expected.push_back(slab_range(direction, min, max) < length);
  }
  std::vector<std::uint8_t> blocked(segments.size(), 2);
  scene.cast(segments, blocked);
  EXPECT_EQ(blocked, expected);
  for (Segment& segment : segments) std::swap(segment.from, segment.to);
  scene.cast(segments, blocked);
  EXPECT_EQ(blocked, expected) << "whichever way";
}

TEST(RayScene, EmptySceneHasNoHits) {
  const RayScene scene({}, Eigen::Vector3d::Zero());
  const std::vector<Ray> rays(5);
  std::vector<RayHit> hits(5);
  scene.cast(rays, 100, hits);
  for (const RayHit& hit : hits) EXPECT_FALSE(hit.hit());
  std::vector<std::uint8_t> blocked(5, 1);
  scene.cast(std::vector<Segment>(5), blocked);
  EXPECT_EQ(blocked, std::vector<std::uint8_t>(5, 0));
}

}  // namespace
}  // namespace priormap
