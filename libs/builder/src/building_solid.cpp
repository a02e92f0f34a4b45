#include <priormap/builder/building_solid.hpp>

#include <Eigen/Geometry>
#include <algorithm>

namespace priormap {
namespace {

std::optional<double> z_over(const Polygon3& face, const Eigen::Vector2d& place) {
  Ring2 plan;
  plan.reserve(face.exterior.size());
  for (const Eigen::Vector3d& p : face.exterior) plan.push_back(p.head<2>());
  if (!contains(plan, place)) return std::nullopt;
  const Eigen::Vector3d normal = newell_normal(face.exterior), &anchor = face.exterior.front();
  if (!(std::abs(normal.z()) > 0)) return std::nullopt;
  const Eigen::Vector2d from_anchor = place - anchor.head<2>();
  return anchor.z() - normal.head<2>().dot(from_anchor) / normal.z();
}

}  // namespace

std::vector<Face> BuildingSolid::faces(bool with_underside) const {
  return roofed_faces(outline, base_z, roof ? *roof : flat_roof(outline, top_z), has_walls, with_underside);
}

double BuildingSolid::roof_z(const Eigen::Vector2d& place) const {
  if (!roof) return top_z;
  double z = eaves_z;
  for (const Polygon3& face : roof->faces)
    if (const std::optional<double> over = z_over(face, place)) z = std::max(z, *over);
  return z;
}

bool BuildingSolid::holds(const Eigen::Vector3d& point, double tolerance_m) const {
  if (point.z() > top_z + tolerance_m || (!on_ground && point.z() < base_z - tolerance_m)) return false;
  const Eigen::Vector2d place = point.head<2>();
  return bounds.min_x <= place.x() && place.x() <= bounds.max_x && bounds.min_y <= place.y() && place.y() <= bounds.max_y &&
         contains(outline, place) && point.z() <= roof_z(place) + tolerance_m;
}

Bounds2 bounds_of(const Ring2& ring) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds2 bounds{infinity, infinity, -infinity, -infinity};
  for (const Eigen::Vector2d& p : ring)
    bounds = {std::min(bounds.min_x, p.x()), std::min(bounds.min_y, p.y()), std::max(bounds.max_x, p.x()), std::max(bounds.max_y, p.y())};
  return bounds;
}

}  // namespace priormap
