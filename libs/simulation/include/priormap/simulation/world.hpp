#pragma once
#include <cstdint>
#include <vector>

#include <priormap/raycast/ray_scene.hpp>
#include <priormap/simulation/town.hpp>

namespace priormap {

enum class Material : std::uint8_t { asphalt, lawn, wall, roof, glass, metal, paint, bark, foliage };

/// How a kind of object is seen by an airborne survey.
enum class Survey : std::uint8_t {
  seen,        ///< in the surface model
  ignored,     ///< too thin or not there that day: poles, fences, cars, buildings built since
};

struct WorldPart {
  Material material;
  Survey survey;
};

/// A town as triangles in frame `map`, ready for rays. Part i is made of `meshes[i]`; hits name parts by their `mesh`.
struct World {
  std::vector<WorldPart> parts;
  std::vector<TriangleMesh> meshes;
  RayScene scene;

  /// Height of the first surface from above that a survey sees, for each position; NaN where there is none.
  std::vector<float> surface_heights(const std::vector<Eigen::Vector2d>& p_map) const;
};

/// Walls with recessed windows and balconies, pitched roofs with overhang, trees of leaves, poles, cars, hedges, fences, ground.
World build_world(const Town& town, std::uint64_t seed);

/// A car as body and glazed cabin: appended to `body` and `glass`, frame `map`.
void append_car(TriangleMesh& body, TriangleMesh& glass, const Car& car);

}  // namespace priormap
