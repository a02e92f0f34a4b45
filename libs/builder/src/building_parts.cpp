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

/// Places inside, evenly spread.
std::vector<Eigen::Vector2d> places_inside(const ProjectedFootprint& footprint) {
  double size = 0;
  for (const Polygon2& polygon : footprint.polygons) size += area(polygon);
  const double step = std::sqrt(size / 400);
  const Bounds2& b = footprint.bounds;
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
