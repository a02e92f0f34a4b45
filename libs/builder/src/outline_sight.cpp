#include <limits>

#include <priormap/tessellation/triangulate.hpp>

#include "drive_axis.hpp"
#include "outline_stages.hpp"

namespace priormap {
namespace {

constexpr double sure_share = 0.5;   // of a guessed height: what lies behind may well be seen

bool is_guess(HeightRule rule) { return rule == HeightRule::levels || rule == HeightRule::fallback; }

/// What surely hides the view: no canopies.
TriangleMesh occluders(std::size_t num_footprints, const BuildingRaiser& raiser) {
  TriangleMesh mesh;
  Diagnostics ignored;   // reported by those who write the building
  for (std::uint32_t i = 0; i < num_footprints; ++i) {
    Building building = raiser.raise(i, ignored);
    for (BuildingSolid& solid : building.solids) {
      if (!solid.has_walls) continue;
      if (is_guess(building.rule)) {
        solid.roof.reset();
        solid.top_z = solid.base_z + sure_share * (solid.top_z - solid.base_z);
      }
      for (const Face& face : solid.faces(true)) mesh.append(triangulate(face.polygon));
    }
  }
  return mesh;
}

}  // namespace

std::optional<LineOfSight> line_of_sight(const ProjectedFootprints& footprints, const PartAssignment& parts, const OutlineFrames& frames, const OutlineOptions& options) {
  if (!options.sight.is_active()) return std::nullopt;
  std::vector<Eigen::Vector3d> viewpoints;
  for (const Eigen::Vector2d& place : places_along_axis(options.sight.visible_from, frames.prior)) {
    const std::optional<double> ground_z = frames.ground.at(place);
    viewpoints.emplace_back(place.x(), place.y(), ground_z ? *ground_z + options.sight.sensor_height_m : std::numeric_limits<double>::quiet_NaN());
  }
  return LineOfSight(std::move(viewpoints), occluders(footprints.size(), BuildingRaiser(footprints, parts, frames, options)), options.sight.view_range_m);
}

}  // namespace priormap
