#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace priormap {

/// Triangles over shared vertices; counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;                 ///< in a projected CRS or a metric frame [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// CityGML's boundary surfaces, as far as a prior tells them apart.
enum class SurfaceClass : std::uint8_t { wall, roof, ground_surface, outer_floor, outer_ceiling, closure, opening, terrain, bridge, vegetation, unclassified };

/// One mesh of one kind, of one feature.
struct Surface {
  TriangleMesh mesh;
  SurfaceClass surface_class = SurfaceClass::unclassified;
  std::uint32_t feature = 0xffffffffu;      ///< index of the feature within its source
  float sigma_m = 0;
};

double area(const TriangleMesh& mesh);

}  // namespace priormap
