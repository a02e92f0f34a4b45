#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <priormap/tessellation/polygon.hpp>

namespace priormap {

/// Triangles over shared vertices; counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< in a projected CRS or a metric frame [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;
  void append(const TriangleMesh& other);
};

/// CityGML's boundary surfaces, as far as a prior tells them apart.
enum class SurfaceClass : std::uint8_t { wall, roof, ground_surface, outer_floor, outer_ceiling, closure, opening, terrain, bridge, vegetation, unclassified };

/// One mesh of one kind, of one feature.
struct Surface {
  TriangleMesh mesh;
  SurfaceClass surface_class = SurfaceClass::unclassified;
  std::uint32_t feature = 0xffffffffu;  ///< index of the feature within its source
  float sigma_m = 0;
};

/// One planar polygon of one kind: what buildings are made of before anything is triangulated.
struct Face {
  Polygon3 polygon;
  SurfaceClass surface_class = SurfaceClass::unclassified;
};

double area(const TriangleMesh& mesh);
/// Signed volume enclosed by a closed mesh, positive when its triangles face outward.
double enclosed_volume(const TriangleMesh& mesh);

/// The faces triangulated, one Surface a class in order of SurfaceClass (feature and sigma left at their defaults).
std::vector<Surface> to_surfaces(std::span<const Face> faces);

}  // namespace priormap
