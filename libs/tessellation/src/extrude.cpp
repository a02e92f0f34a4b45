#include <priormap/tessellation/extrude.hpp>

#include <algorithm>

namespace priormap {
namespace {

Ring3 at_level(const Ring2& ring, double z, bool reversed) {
  Ring3 lifted;
  lifted.reserve(ring.size());
  for (const Eigen::Vector2d& p : ring) lifted.emplace_back(p.x(), p.y(), z);
  if (reversed) std::ranges::reverse(lifted);
  return lifted;
}

}  // namespace

Face wall_face(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double base_z, double top_z) {
  return {{{{from.x(), from.y(), base_z}, {to.x(), to.y(), base_z}, {to.x(), to.y(), top_z}, {from.x(), from.y(), top_z}}, {}}, SurfaceClass::wall};
}

Face level_face(const Polygon2& outline, double z, SurfaceClass surface_class, bool facing_up) {
  Face face{{at_level(outline.exterior, z, !facing_up), {}}, surface_class};
  for (const Ring2& hole : outline.holes) face.polygon.holes.push_back(at_level(hole, z, !facing_up));
  return face;
}

std::vector<Face> block_faces(const Polygon2& outline, double base_z, double top_z, bool with_underside) {
  std::vector<Face> faces;
  for_each_ring(outline, [&](const Ring2& ring) {
    for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { faces.push_back(wall_face(a, b, base_z, top_z)); });
  });
  faces.push_back(level_face(outline, top_z, SurfaceClass::roof, true));
  if (with_underside) faces.push_back(level_face(outline, base_z, SurfaceClass::outer_floor, false));
  return faces;
}

std::vector<Surface> extrude(const Polygon2& outline, double base_z, double top_z) {
  return to_surfaces(block_faces(outline, base_z, top_z, false));
}

}  // namespace priormap
