#include <priormap/tessellation/polygon.hpp>

#include <Eigen/Geometry>

namespace priormap {

double signed_area(const Ring2& ring) {
  if (ring.empty()) return 0;
  const Eigen::Vector2d& anchor = ring.front();  // local coordinates keep the products small
  double twice = 0;
  for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d p = a - anchor, q = b - anchor;
    twice += p.x() * q.y() - p.y() * q.x();
  });
  return 0.5 * twice;
}

double area(const Polygon2& polygon) {
  double sum = std::abs(signed_area(polygon.exterior));
  for (const Ring2& hole : polygon.holes) sum -= std::abs(signed_area(hole));
  return sum;
}

double area(const Polygon3& polygon) { return 0.5 * newell_normal(polygon).norm(); }

bool contains(const Ring2& ring, const Eigen::Vector2d& point) {
  bool inside = false;
  for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    if ((a.y() <= point.y()) == (b.y() <= point.y())) return;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  });
  return inside;
}

bool contains(const Polygon2& polygon, const Eigen::Vector2d& point) {
  bool inside = contains(polygon.exterior, point);
  for (const Ring2& hole : polygon.holes) inside ^= contains(hole, point);
  return inside;
}

Eigen::Vector3d newell_normal(const Ring3& ring) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  if (ring.empty()) return normal;
  const Eigen::Vector3d& anchor = ring.front();
  for_each_edge(ring, [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { normal += (a - anchor).cross(b - anchor); });
  return normal;
}

Eigen::Vector3d newell_normal(const Polygon3& polygon) {
  Eigen::Vector3d normal = newell_normal(polygon.exterior);
  for (const Ring3& hole : polygon.holes) {
    const Eigen::Vector3d of_hole = newell_normal(hole);
    normal += of_hole.dot(normal) > 0 ? Eigen::Vector3d(-of_hole) : of_hole;  // holes count off whichever way they run
  }
  return normal;
}

}  // namespace priormap
