#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <priormap/tessellation/extrude.hpp>

namespace priormap {
namespace {

const Polygon2 outline{{{0, 0}, {12, 0}, {12, 5}, {6, 5}, {6, 9}, {0, 9}}, {{{2, 2}, {2, 4}, {4, 4}, {4, 2}}}};

TEST(Extrude, TheFacesEncloseTheBlock) {
  TriangleMesh mesh;
  for (const Surface& surface : to_surfaces(block_faces(outline, 500, 507, true))) mesh.append(surface.mesh);
  EXPECT_NEAR(enclosed_volume(mesh), 7 * area(outline), 1e-9) << "a positive volume: every face looks outward";
}

TEST(Extrude, WallsAndAFlatRoof) {
  const std::vector<Surface> surfaces = extrude(outline, 500, 507);
  ASSERT_EQ(surfaces.size(), 2u);
  EXPECT_EQ(surfaces[0].surface_class, SurfaceClass::wall);
  EXPECT_NEAR(area(surfaces[0].mesh), 7 * (12 + 5 + 6 + 4 + 6 + 9 + 4 * 2), 1e-9);
  EXPECT_EQ(surfaces[1].surface_class, SurfaceClass::roof);
  EXPECT_NEAR(area(surfaces[1].mesh), area(outline), 1e-9);
  for (const auto& [a, b, c] : surfaces[1].mesh.triangles) {
    const auto& v = surfaces[1].mesh.vertices;
    EXPECT_GT((v[b] - v[a]).cross(v[c] - v[a]).z(), 0);
    EXPECT_EQ(v[a].z(), 507);
  }
}

TEST(Extrude, WallsLookAwayFromTheInside) {
  for (const Face& face : block_faces(outline, 0, 3, false)) {
    if (face.surface_class != SurfaceClass::wall) continue;
    const Eigen::Vector3d normal = newell_normal(face.polygon).normalized();
    const Eigen::Vector2d middle = 0.5 * (face.polygon.exterior[0] + face.polygon.exterior[1]).head<2>();
    EXPECT_FALSE(contains(outline, middle + 0.1 * normal.head<2>()));
    EXPECT_TRUE(contains(outline, middle - 0.1 * normal.head<2>()));
  }
}

}  // namespace
}  // namespace priormap
