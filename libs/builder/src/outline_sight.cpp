#include <limits>

#include <priormap/tessellation/triangulate.hpp>

#include "drive_axis.hpp"
#include "outline_stages.hpp"

namespace priormap {
namespace {

constexpr double sure_share = 0.5;   // of a guessed height: what lies behind may well be seen

bool is_guess(HeightRule rule) { return rule == HeightRule::levels || rule == HeightRule::fallback; }

/// What surely hides the view: no canopies.
TriangleMesh occluders(const std::vector<Building>& buildings) {
  TriangleMesh mesh;
  for (const Building& building : buildings)
    for (BuildingSolid solid : building.solids) {
      if (!solid.has_walls) continue;
      if (is_guess(building.rule)) {
        solid.roof.reset();
        solid.top_z = solid.base_z + sure_share * (solid.top_z - solid.base_z);
      }
      for (const Face& face : solid.faces(true)) mesh.append(triangulate(face.polygon));
    }
  return mesh;
}

}  // namespace

std::optional<LineOfSight> line_of_sight(const std::vector<Building>& buildings, const OutlineFrames& frames, const SightOptions& options) {
  if (!options.is_active()) return std::nullopt;
  std::vector<Eigen::Vector3d> viewpoints;
  for (const Eigen::Vector2d& place : places_along_axis(options.visible_from, frames.prior)) {
    const std::optional<double> ground_z = frames.ground.at(place);
    viewpoints.emplace_back(place.x(), place.y(), ground_z ? *ground_z + options.sensor_height_m : std::numeric_limits<double>::quiet_NaN());
  }
  return LineOfSight(std::move(viewpoints), occluders(buildings), options.view_range_m);
}

}  // namespace priormap
