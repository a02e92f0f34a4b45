#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <priormap/tessellation/roof.hpp>

namespace priormap {
namespace {

const Polygon2 rectangle{{{0, 0}, {12, 0}, {12, 8}, {0, 8}}, {}};
const Polygon2 l_shape{{{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 22}, {0, 22}}, {}};
const Polygon2 courtyard{{{0, 0}, {30, 0}, {30, 30}, {0, 30}}, {{{10, 10}, {10, 20}, {20, 20}, {20, 10}}}};
const Polygon2 octagon{{{4, 0}, {8, 0}, {12, 4}, {12, 8}, {8, 12}, {4, 12}, {0, 8}, {0, 4}}, {}};

constexpr double eaves_z = 100, rise_m = 4;

std::vector<Face> house(const Polygon2& outline, const RoofSpec& spec, double base_z) {
  const auto roof = make_roof(outline, eaves_z, spec);
  EXPECT_TRUE(roof);
  return roof ? roofed_faces(outline, base_z, *roof, true, true) : std::vector<Face>{};
}

/// A closed solid: its volume is independent of where it is measured from, and equals what geometry says.
double volume(const std::vector<Face>& faces) {
  TriangleMesh mesh;
  for (const Surface& surface : to_surfaces(faces)) mesh.append(surface.mesh);
  const double here = enclosed_volume(mesh);
  TriangleMesh far = mesh;
  far.vertices.insert(far.vertices.begin(), {500, -300, 90});  // enclosed_volume measures from the first vertex
  for (auto& triangle : far.triangles) for (auto& index : triangle) ++index;
  EXPECT_NEAR(enclosed_volume(far), here, 1e-6 * std::abs(here)) << "the faces do not close";
  return here;
}

void expect_between_eaves_and_top(const std::vector<Face>& faces) {
  double top = 0;
  for (const Face& face : faces) {
    if (face.surface_class != SurfaceClass::roof) continue;
    for_each_ring(face.polygon, [&](const Ring3& ring) {
      for (const auto& p : ring) {
        EXPECT_GE(p.z(), eaves_z - 1e-6);
        EXPECT_LE(p.z(), eaves_z + rise_m + 1e-6);
        top = std::max(top, p.z());
      }
    });
  }
  EXPECT_NEAR(top, eaves_z + rise_m, 1e-6);
}

TEST(Roof, VolumesOfRoofsOverARectangle) {
  const double base = 90, walls = 12 * 8 * 10;
  const std::vector<std::pair<RoofShape, double>> shares{  // of the box over the eaves
      {RoofShape::flat, 1},      {RoofShape::gabled, 0.5}, {RoofShape::skillion, 0.5}, {RoofShape::pyramidal, 1.0 / 3},
      {RoofShape::cone, 1.0 / 3}, {RoofShape::hipped, 0.5 - 8.0 / 12 / 6}, {RoofShape::gambrel, 2.0 / 3 * 1.0 / 3 * 0.5 + 2.0 / 3 * 5.0 / 6}};
  for (const auto& [shape, share] : shares) {
    const auto faces = house(rectangle, {shape, rise_m}, base);
    EXPECT_NEAR(volume(faces), walls + share * 12 * 8 * rise_m, 1e-6) << "shape " << int(shape);
    expect_between_eaves_and_top(faces);
  }
}

TEST(Roof, EveryShapeClosesOverEveryOutline) {
  for (const Polygon2& outline : {rectangle, l_shape, courtyard, octagon})
    for (int shape = 0; shape < int(RoofShape::other); ++shape)
      for (const bool across : {false, true}) {
        const auto roof = make_roof(outline, eaves_z, {RoofShape(shape), rise_m, {}, across});
        if (!roof) continue;
        const auto faces = roofed_faces(outline, 90, *roof, true, true);
        const double v = volume(faces);
        EXPECT_GT(v, 10 * area(outline));
        EXPECT_LE(v, (10 + rise_m) * area(outline) + 1e-6);
        expect_between_eaves_and_top(faces);
      }
}

TEST(Roof, WhichShapesCannotBeBuilt) {
  EXPECT_FALSE(make_roof(courtyard, eaves_z, {RoofShape::dome, rise_m}));
  EXPECT_FALSE(make_roof(rectangle, eaves_z, {RoofShape::other, rise_m}));
  EXPECT_TRUE(make_roof(courtyard, eaves_z, {RoofShape::pyramidal, rise_m})) << "the skeleton serves where there is no one centre";
}

double wall_area(const std::vector<Face>& faces, const Eigen::Vector3d& outward) {
  double sum = 0;
  for (const Face& face : faces)
    if (face.surface_class == SurfaceClass::wall && newell_normal(face.polygon).normalized().dot(outward) > 0.99) sum += area(face.polygon);
  return sum;
}

TEST(Roof, TheRidgeRunsAlongTheLongerSideUnlessToldOtherwise) {
  const auto along = house(rectangle, {RoofShape::gabled, rise_m}, eaves_z);
  EXPECT_NEAR(wall_area(along, {1, 0, 0}), 0.5 * 8 * rise_m, 1e-9) << "a gable over the shorter side";
  EXPECT_NEAR(wall_area(along, {0, 1, 0}), 0, 1e-9);
  const auto across = house(rectangle, {RoofShape::gabled, rise_m, {}, true}, eaves_z);
  EXPECT_NEAR(wall_area(across, {0, 1, 0}), 0.5 * 12 * rise_m, 1e-9);
}

TEST(Roof, ASkillionFallsInItsDirection) {
  const auto faces = house(rectangle, {RoofShape::skillion, rise_m, 90.0}, eaves_z);  // down to the east
  EXPECT_NEAR(wall_area(faces, {-1, 0, 0}), 8 * rise_m, 1e-9);
  EXPECT_NEAR(wall_area(faces, {1, 0, 0}), 0, 1e-9);
}

TEST(Roof, GablesOfAnLShapeStandOnItsTwoEnds) {
  const auto faces = house(l_shape, {RoofShape::gabled, rise_m}, eaves_z);
  EXPECT_NEAR(wall_area(faces, {1, 0, 0}), 0.5 * 8 * rise_m, 1e-6);
  EXPECT_NEAR(wall_area(faces, {0, 1, 0}), 0.5 * 8 * rise_m, 1e-6);
  EXPECT_NEAR(wall_area(faces, {-1, 0, 0}) + wall_area(faces, {0, -1, 0}), 0, 1e-6);
}

TEST(Roof, HalfHippedGablesAreCutHalfwayUp) {
  const auto faces = house(rectangle, {RoofShape::half_hipped, rise_m}, eaves_z);
  EXPECT_NEAR(wall_area(faces, {1, 0, 0}), (8 + 4) / 2.0 * rise_m / 2, 1e-9) << "a trapezoid";
}

TEST(Roof, ADomeApproachesHalfAnEllipsoid) {
  Polygon2 disk;
  for (int i = 0; i < 64; ++i) disk.exterior.emplace_back(10 * std::cos(2 * M_PI * i / 64), 10 * std::sin(2 * M_PI * i / 64));
  EXPECT_NEAR(volume(house(disk, {RoofShape::dome, rise_m}, eaves_z)), 2.0 / 3 * M_PI * 100 * rise_m, 0.02 * 838);
}

TEST(Roof, TheRunOfARoof) {
  EXPECT_NEAR(roof_run_m(rectangle, {RoofShape::gabled, 1}), 4, 1e-9);
  EXPECT_NEAR(roof_run_m(rectangle, {RoofShape::skillion, 1}), 8, 1e-9);
  EXPECT_NEAR(roof_run_m(rectangle, {RoofShape::hipped, 1}), 4, 1e-9);
  EXPECT_NEAR(roof_run_m(courtyard, {RoofShape::hipped, 1}), 5, 1e-9);
}

TEST(Roof, ACanopyHasNoWalls) {
  const auto faces = roofed_faces(rectangle, 90, flat_roof(rectangle, 93), false, true);
  ASSERT_EQ(faces.size(), 2u);
  EXPECT_EQ(faces[1].surface_class, SurfaceClass::outer_ceiling);
  EXPECT_LT(newell_normal(faces[1].polygon).z(), 0);
}

}  // namespace
}  // namespace priormap
