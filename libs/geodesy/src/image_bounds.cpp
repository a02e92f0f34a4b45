#include <priormap/geodesy/image_bounds.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace priormap {
namespace {

constexpr int edge_steps = 64, interior_steps = 8;

using Mapping = std::function<void(std::span<Eigen::Vector3d>)>;

struct Range {
  double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();
  double extent() const { return max - min; }
};

/// One edge in the other CRS: its extent in x and y.
struct Edge {
  Range x, y;
};

std::optional<Edge> transformed_edge(const Eigen::Vector2d& begin, const Eigen::Vector2d& end, const Mapping& transform) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= edge_steps; ++i) {
    const Eigen::Vector2d p = begin + (end - begin) * (static_cast<double>(i) / edge_steps);
    points.emplace_back(p.x(), p.y(), 0);
  }
  transform(points);
  Edge edge;
  for (const Eigen::Vector3d& p : points) {
    if (!p.allFinite()) return std::nullopt;
    edge.x = {std::min(edge.x.min, p.x()), std::max(edge.x.max, p.x())};
    edge.y = {std::min(edge.y.min, p.y()), std::max(edge.y.max, p.y())};
  }
  return edge;
}

/// How far an edge may stray from its points: less than a step's share of how far it strays altogether, and of the rounding.
double margin(const Range& across, const Range& along) {
  return across.extent() / edge_steps + along.extent() * 1e-6 + 1e-12 * std::max(std::abs(across.min), std::abs(across.max));
}

/// Points inside must come to lie inside: not where a rectangle of degrees goes around the Earth.
bool encloses_interior(const Bounds2& b, const Bounds2& outer, const Mapping& transform) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 1; i < interior_steps; ++i)
    for (int j = 1; j < interior_steps; ++j)
      points.emplace_back(b.min_x + (b.max_x - b.min_x) * i / interior_steps, b.min_y + (b.max_y - b.min_y) * j / interior_steps, 0);
  transform(points);
  return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& p) { return outer.contains(p.x(), p.y()); });
}

}  // namespace

std::optional<ImageBounds> image_bounds(const Bounds2& b, const Mapping& transform) {
  const auto west = transformed_edge({b.min_x, b.min_y}, {b.min_x, b.max_y}, transform);
  const auto east = transformed_edge({b.max_x, b.min_y}, {b.max_x, b.max_y}, transform);
  const auto south = transformed_edge({b.min_x, b.min_y}, {b.max_x, b.min_y}, transform);
  const auto north = transformed_edge({b.min_x, b.max_y}, {b.max_x, b.max_y}, transform);
  if (!west || !east || !south || !north) return std::nullopt;

  ImageBounds image;
  image.outer = {std::min({west->x.min, east->x.min, south->x.min, north->x.min}), std::min({west->y.min, east->y.min, south->y.min, north->y.min}),
                 std::max({west->x.max, east->x.max, south->x.max, north->x.max}), std::max({west->y.max, east->y.max, south->y.max, north->y.max})};
  const double margin_x = std::max(margin(west->x, west->y), margin(east->x, east->y)), margin_y = std::max(margin(south->y, south->x), margin(north->y, north->x));
  image.outer.min_x -= margin_x;
  image.outer.max_x += margin_x;
  image.outer.min_y -= margin_y;
  image.outer.max_y += margin_y;
  image.inner = {west->x.max + margin_x, south->y.max + margin_y, east->x.min - margin_x, north->y.min - margin_y};
  if (!encloses_interior(b, image.outer, transform)) return std::nullopt;
  return image;
}

std::optional<ImageBounds> image_bounds(const Bounds2& b, const Transformer& transformer) {
  return image_bounds(b, [&](std::span<Eigen::Vector3d> points) { transformer.forward(points); });
}

}  // namespace priormap
