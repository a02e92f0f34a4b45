#include <priormap/builder/building_parts.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace priormap {
namespace {

bool contains(const std::vector<Polygon2>& polygons, const Eigen::Vector2d& place) {
  return std::ranges::any_of(polygons, [&](const Polygon2& polygon) { return priormap::contains(polygon, place); });
}

/// Where a line at `s` along an axis (0: x, 1: y) crosses the rings, along the other axis, ascending.
std::vector<double> crossings(const std::vector<Polygon2>& polygons, int axis, double s) {
  std::vector<double> found;
  for (const Polygon2& polygon : polygons)
    for_each_ring(polygon, [&](const Ring2& ring) {
      for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        if ((a[axis] > s) != (b[axis] > s)) found.push_back(a[1 - axis] + (s - a[axis]) / (b[axis] - a[axis]) * (b[1 - axis] - a[1 - axis]));
      });
    });
  std::ranges::sort(found);
  return found;
}

/// Places inside a sliver: on lines across the longer side of its bounds, evenly spread over each stretch inside.
std::vector<Eigen::Vector2d> places_along(const ProjectedFootprint& sliver) {
  constexpr int num_lines = 400;
  const Eigen::Vector2d low(sliver.bounds.min_x, sliver.bounds.min_y), size = Eigen::Vector2d(sliver.bounds.max_x, sliver.bounds.max_y) - low;
  const int axis = size.x() >= size.y() ? 0 : 1;
  const double step = size[axis] / num_lines;
  std::vector<Eigen::Vector2d> places;
  for (int line = 0; line < num_lines; ++line) {
    Eigen::Vector2d place;
    place[axis] = low[axis] + (line + 0.5) * step;
    const std::vector<double> ends = crossings(sliver.polygons, axis, place[axis]);
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
      const int on_stretch = 1 + static_cast<int>((ends[i + 1] - ends[i]) / step);
      for (int k = 0; k < on_stretch; ++k) {
        place[1 - axis] = ends[i] + (k + 0.5) / on_stretch * (ends[i + 1] - ends[i]);
        places.push_back(place);
      }
    }
  }
  return places;
}

/// Places inside, evenly spread.
std::vector<Eigen::Vector2d> places_inside(const ProjectedFootprint& footprint) {
  constexpr double num_inside = 400, most_in_bounds = 100 * num_inside;
  double size = 0;
  for (const Polygon2& polygon : footprint.polygons) size += area(polygon);
  const double step = std::sqrt(size / num_inside);
  const Bounds2& b = footprint.bounds;
  const double width = b.max_x - b.min_x, height = b.max_y - b.min_y;
  if (std::min(width, height) <= step || width * height > most_in_bounds * step * step) return places_along(footprint);
  std::vector<Eigen::Vector2d> places;
  for (double y = b.min_y + 0.5 * step; y < b.max_y; y += step)
    for (double x = b.min_x + 0.5 * step; x < b.max_x; x += step)
      if (contains(footprint.polygons, {x, y})) places.emplace_back(x, y);
  return places;
}

bool are_tied(const Footprint& part, const Footprint& outline) { return part.building != Footprint::no_building && part.building == outline.building; }

double share_inside(const std::vector<Eigen::Vector2d>& places, const std::vector<Polygon2>& polygons) {
  if (places.empty()) return 0;
  return static_cast<double>(std::ranges::count_if(places, [&](const auto& place) { return contains(polygons, place); })) / static_cast<double>(places.size());
}

}  // namespace

PartAssignment assign_parts(const ProjectedFootprints& footprints) {
  PartAssignment assignment{std::vector<bool>(footprints.size(), false), std::vector<std::uint32_t>(footprints.size(), PartAssignment::no_outline)};
  std::map<std::uint32_t, std::vector<std::uint32_t>> parts_of;
  for (std::uint32_t i = 0; i < footprints.size(); ++i) {
    if (footprints.kind(i) != Footprint::Kind::part || footprints.is_empty(i)) continue;
    const ProjectedFootprint part = footprints[i];
    const std::vector<Eigen::Vector2d> places = places_inside(part);
    constexpr double least_share = 0.5, share_of_tied = 2;   // before any share that a place gives
    double best_share = least_share;
    for (const std::uint32_t other : footprints.meeting(part.bounds)) {
      if (footprints.kind(other) != Footprint::Kind::outline) continue;
      const ProjectedFootprint outline = footprints[other];
      const double share = are_tied(part.footprint, outline.footprint) ? share_of_tied : share_inside(places, outline.polygons);
      if (share < best_share) continue;
      best_share = share;
      assignment.outline_of[i] = other;
    }
    if (assignment.outline_of[i] != PartAssignment::no_outline) parts_of[assignment.outline_of[i]].push_back(i);
  }

  for (const auto& [outline, numbers] : parts_of) {
    std::vector<Polygon2> parts;
    for (const std::uint32_t part : numbers) std::ranges::move(footprints[part].polygons, std::back_inserter(parts));
    assignment.replaced[outline] = share_inside(places_inside(footprints[outline]), parts) >= filled_share;
  }
  return assignment;
}

}  // namespace priormap
