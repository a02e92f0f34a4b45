#pragma once
#include <Eigen/Geometry>
#include <optional>

#include <priormap/tessellation/polygon.hpp>

namespace priormap {

/// Right-handed frame in the plane of a polygon: u along its longest edge, v in the plane, n outward.
struct PlaneFrame {
  Eigen::Vector3d origin, u, v, n;

  static std::optional<PlaneFrame> from(const Eigen::Vector3d& origin, const Eigen::Vector3d& along, const Eigen::Vector3d& normal) {
    const double length = normal.norm();
    if (!(length > 0)) return std::nullopt;
    const Eigen::Vector3d n = normal / length;
    const Eigen::Vector3d in_plane = along - n * n.dot(along);
    if (!(in_plane.norm() > 0)) return std::nullopt;
    const Eigen::Vector3d u = in_plane.normalized();
    return PlaneFrame{origin, u, n.cross(u), n};
  }

  /// Best-fit plane by Newell's method through the mean vertex of the exterior; nullopt for a polygon without area.
  static std::optional<PlaneFrame> of(const Polygon3& polygon) {
    if (polygon.exterior.size() < 3) return std::nullopt;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), along = Eigen::Vector3d::Zero();
    const Eigen::Vector3d& anchor = polygon.exterior.front();
    for_each_edge(polygon.exterior, [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      mean += a - anchor;
      if ((b - a).squaredNorm() > along.squaredNorm()) along = b - a;
    });
    return from(anchor + mean / static_cast<double>(polygon.exterior.size()), along, newell_normal(polygon));
  }

  Eigen::Vector2d to_plane(const Eigen::Vector3d& p) const { return {u.dot(p - origin), v.dot(p - origin)}; }
  double height(const Eigen::Vector3d& p) const { return n.dot(p - origin); }
  Eigen::Vector3d to_space(const Eigen::Vector2d& p) const { return origin + u * p.x() + v * p.y(); }
};

}  // namespace priormap
