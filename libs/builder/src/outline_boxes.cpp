#include "outline_boxes.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace priormap {
namespace {

using Edge = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

bool passes_through(const Edge& edge, const Bounds2& box) {
  const auto& [a, b] = edge;
  if (std::max(a.x(), b.x()) < box.min_x || std::min(a.x(), b.x()) > box.max_x || std::max(a.y(), b.y()) < box.min_y || std::min(a.y(), b.y()) > box.max_y) return false;
  const Eigen::Vector2d along = b - a;
  const auto side = [&](double x, double y) { return along.x() * (y - a.y()) - along.y() * (x - a.x()); };
  const double corners[] = {side(box.min_x, box.min_y), side(box.max_x, box.min_y), side(box.min_x, box.max_y), side(box.max_x, box.max_y)};
  const auto [low, high] = std::ranges::minmax(corners);
  return low <= 0 && high >= 0;
}

class Division {
 public:
  Division(const std::vector<Polygon2>& polygons, double longest_m) : polygons_(polygons), longest_m_(longest_m) {}

  /// @param edges  those that pass through a box around this one
  void divide(const Bounds2& box, const std::vector<Edge>& edges) {
    std::vector<Edge> own;
    std::ranges::copy_if(edges, std::back_inserter(own), [&](const Edge& edge) { return passes_through(edge, box); });
    const double width = box.max_x - box.min_x, height = box.max_y - box.min_y;
    const Eigen::Vector2d middle(box.min_x + 0.5 * width, box.min_y + 0.5 * height);
    if (own.empty()) {
      if (std::ranges::any_of(polygons_, [&](const Polygon2& polygon) { return contains(polygon, middle); })) boxes.push_back(box);
    } else if (!(std::max(width, height) > longest_m_)) {
      boxes.push_back(box);
    } else if (width >= height) {
      divide({box.min_x, box.min_y, middle.x(), box.max_y}, own);
      divide({middle.x(), box.min_y, box.max_x, box.max_y}, own);
    } else {
      divide({box.min_x, box.min_y, box.max_x, middle.y()}, own);
      divide({box.min_x, middle.y(), box.max_x, box.max_y}, own);
    }
  }

  std::vector<Bounds2> boxes;

 private:
  const std::vector<Polygon2>& polygons_;
  const double longest_m_;
};

}  // namespace

std::vector<Bounds2> boxes_over(const std::vector<Polygon2>& polygons, const Bounds2& bounds, double longest_m) {
  if (!(longest_m > 0)) return {bounds};
  std::vector<Edge> edges;
  for (const Polygon2& polygon : polygons)
    for_each_ring(polygon, [&](const Ring2& ring) { for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { edges.emplace_back(a, b); }); });
  Division division(polygons, longest_m);
  division.divide(bounds, edges);
  return std::move(division.boxes);
}

}  // namespace priormap
