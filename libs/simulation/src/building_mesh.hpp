#pragma once
#include <priormap/simulation/town.hpp>
#include <priormap/tessellation/surface.hpp>

#include <priormap/simulation/random.hpp>

namespace priormap {

struct BuildingMeshes {
  TriangleMesh walls, glass, roof;
};

/// Appends one building: walls with window recesses and balconies along every ring, the roof with its overhang, a chimney.
void append_building(BuildingMeshes& meshes, const Building& building, Random random);

}  // namespace priormap
