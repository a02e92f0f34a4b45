#pragma once
#include <Eigen/Core>
#include <vector>

namespace priormap {

/// Closed ring without repeating the first vertex.
using Ring2 = std::vector<Eigen::Vector2d>;
using Ring3 = std::vector<Eigen::Vector3d>;

/// Polygon in the plane with holes; exterior counter-clockwise, holes clockwise after `normalize`.
struct Polygon2 {
  Ring2 exterior;
  std::vector<Ring2> holes;
};

/// Polygon in space with holes, ideally planar; its exterior runs counter-clockwise seen from outside (from its normal's side).
struct Polygon3 {
  Ring3 exterior;
  std::vector<Ring3> holes;
};

double signed_area(const Ring2& ring);  ///< positive counter-clockwise
double area(const Polygon2& polygon);   ///< less its holes
double area(const Polygon3& polygon);   ///< of its projection onto its own plane
bool contains(const Ring2& ring, const Eigen::Vector2d& point);         ///< even-odd; the edge itself may go either way
bool contains(const Polygon2& polygon, const Eigen::Vector2d& point);   ///< even-odd; the edge itself may go either way
Eigen::Vector3d newell_normal(const Ring3& ring);  ///< length = twice the area
Eigen::Vector3d newell_normal(const Polygon3& polygon);  ///< of all its rings: length = twice the area less holes

/// Calls `visit(ring)` for the exterior, then for each hole.
template <class Polygon, class Visitor>
void for_each_ring(Polygon& polygon, Visitor&& visit) {
  visit(polygon.exterior);
  for (auto& hole : polygon.holes) visit(hole);
}

/// Calls `visit(from, to)` for each edge of a ring.
template <class Ring, class Visitor>
void for_each_edge(const Ring& ring, Visitor&& visit) {
  for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]);
}

}  // namespace priormap
