#include <priormap/tessellation/normalize.hpp>

#include <algorithm>

#include "even_odd.hpp"

namespace priormap {
namespace {

constexpr double same_point_m = 1e-3;   // below the resolution of every source
constexpr double least_area_m2 = 0.01;

struct RingEdge {
  Eigen::Vector2d a, b;
  std::size_t ring, index, ring_size;
  double min_x, max_x;
  bool is_next_to(const RingEdge& other) const {
    return ring == other.ring && ((index + 1) % ring_size == other.index || (other.index + 1) % ring_size == index);
  }
};

struct Contacts {
  bool within_ring = false;      ///< a ring crosses itself
  bool between_rings = false;    ///< two rings cross
  bool touching = false;         ///< rings share points or stretches beside their order along the ring
  bool any() const { return within_ring || between_rings || touching; }
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Signed distance of p from the line through the edge.
double distance_from_line(const RingEdge& edge, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = edge.b - edge.a;
  return cross(along, p - edge.a) / along.norm();
}

bool lies_on(const RingEdge& edge, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = edge.b - edge.a;
  const double t = std::clamp((p - edge.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (edge.a + t * along - p).norm() <= same_point_m;
}

bool opposite_sides(double a, double b) { return (a > same_point_m && b < -same_point_m) || (a < -same_point_m && b > same_point_m); }

bool crosses(const RingEdge& p, const RingEdge& q) {
  return opposite_sides(distance_from_line(p, q.a), distance_from_line(p, q.b)) &&
         opposite_sides(distance_from_line(q, p.a), distance_from_line(q, p.b));
}

bool touches(const RingEdge& p, const RingEdge& q) {
  if (p.is_next_to(q)) {  // neighbours share one end by right; they touch where one folds back onto the other
    const bool p_first = (p.index + 1) % p.ring_size == q.index;
    const RingEdge &first = p_first ? p : q, &second = p_first ? q : p;
    return p.ring_size > 2 && (lies_on(first, second.b) || lies_on(second, first.a));
  }
  return lies_on(p, q.a) || lies_on(p, q.b) || lies_on(q, p.a) || lies_on(q, p.b);
}

std::vector<RingEdge> edges_of(const std::vector<Ring2>& rings) {
  std::vector<RingEdge> edges;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const Ring2& ring = rings[r];
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[i + 1 == ring.size() ? 0 : i + 1];
      edges.push_back({a, b, r, i, ring.size(), std::min(a.x(), b.x()) - same_point_m, std::max(a.x(), b.x()) + same_point_m});
    }
  }
  return edges;
}

/// Compares edges whose x ranges overlap.
Contacts find_contacts(const std::vector<Ring2>& rings) {
  std::vector<RingEdge> edges = edges_of(rings);
  std::ranges::sort(edges, {}, &RingEdge::min_x);
  Contacts contacts;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [low, high] = std::minmax(edges[i].a.y(), edges[i].b.y());
    for (std::size_t j = i + 1; j < edges.size() && edges[j].min_x <= edges[i].max_x; ++j) {
      const auto [other_low, other_high] = std::minmax(edges[j].a.y(), edges[j].b.y());
      if (other_low > high + same_point_m || other_high < low - same_point_m) continue;
      if (crosses(edges[i], edges[j]))
        (edges[i].ring == edges[j].ring ? contacts.within_ring : contacts.between_rings) = true;
      else if (!contacts.touching && touches(edges[i], edges[j]))
        contacts.touching = true;
    }
  }
  return contacts;
}

bool same_point(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return (a - b).squaredNorm() <= same_point_m * same_point_m; }

/// Without repeated points; a last point that repeats the first is how many formats close a ring, and no defect.
Ring2 without_repeats(const Ring2& ring, bool& repeats) {
  Ring2 clean;
  clean.reserve(ring.size());
  for (const Eigen::Vector2d& p : ring) {
    if (clean.empty() || !same_point(clean.back(), p)) clean.push_back(p);
    else repeats = true;
  }
  while (clean.size() > 1 && same_point(clean.front(), clean.back())) clean.pop_back();
  return clean;
}

Ring2 canonical(Ring2 ring) {
  if (signed_area(ring) < 0) std::ranges::reverse(ring);
  const auto smaller = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); };
  std::ranges::rotate(ring, std::ranges::min_element(ring, smaller));
  return ring;
}

bool drop_duplicates(std::vector<Ring2>& rings) {
  std::vector<Ring2> seen;
  return std::erase_if(rings, [&](const Ring2& ring) {
    Ring2 key = canonical(ring);
    if (std::ranges::find(seen, key) != seen.end()) return true;
    seen.push_back(std::move(key));
    return false;
  }) > 0;
}

std::vector<Polygon2> repaired(const std::vector<Ring2>& rings) {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> edges;
  for (const Ring2& ring : rings)
    for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { edges.emplace_back(a, b); });
  return even_odd_polygons(edges);
}

}  // namespace

std::vector<Polygon2> normalize(const std::vector<Ring2>& rings, const std::string& feature, Diagnostics& diagnostics) {
  std::vector<Ring2> clean;
  bool repeats = false;
  for (const Ring2& ring : rings) {
    Ring2 points = without_repeats(ring, repeats);
    if (points.size() < 3)
      diagnostics.add(DiagnosticCode::too_few_points, feature, "a ring has fewer than three different points; left out");
    else
      clean.push_back(std::move(points));
  }
  if (clean.empty()) return {};
  if (repeats) diagnostics.add(DiagnosticCode::consecutive_points_same, feature, "a ring repeats a point; dropped");
  if (clean.size() > 1 && drop_duplicates(clean)) diagnostics.add(DiagnosticCode::duplicated_rings, feature, "a ring is given twice; used once");

  const Contacts contacts = find_contacts(clean);
  if (contacts.within_ring) diagnostics.add(DiagnosticCode::ring_self_intersection, feature, "a ring crosses itself; split where it does");
  if (contacts.between_rings) diagnostics.add(DiagnosticCode::intersection_rings, feature, "rings cross each other; split where they do");

  std::vector<Polygon2> polygons;
  if (clean.size() == 1 && !contacts.any()) {
    if (signed_area(clean.front()) < 0) std::ranges::reverse(clean.front());
    polygons.push_back({std::move(clean.front()), {}});
  } else {
    polygons = repaired(clean);
  }
  std::erase_if(polygons, [](const Polygon2& polygon) { return area(polygon) < least_area_m2; });
  if (polygons.empty()) diagnostics.add(DiagnosticCode::degenerate_geometry, feature, "its rings enclose no area; left out");
  return polygons;
}

std::vector<Polygon2> normalize(const Polygon2& polygon, const std::string& feature, Diagnostics& diagnostics) {
  std::vector<Ring2> rings{polygon.exterior};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  return normalize(rings, feature, diagnostics);
}

}  // namespace priormap
