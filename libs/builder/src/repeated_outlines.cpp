#include "repeated_outlines.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>

namespace priormap {
namespace {

auto order_of(const Bounds2& b) { return std::tuple(b.min_x, b.min_y, b.max_x, b.max_y); }

/// Equal for footprints that would be built over each other: their edges, and what they start from.
struct Stand {
  std::vector<std::array<double, 4>> edges;
  double min_height_m, min_level;
  bool has_walls;

  auto operator<=>(const Stand&) const = default;
};

Stand stand_of(const ProjectedFootprint& projected) {
  const BuildingAttributes& attributes = projected.footprint.attributes;
  Stand stand{{}, attributes.min_height_m.value_or(0), attributes.min_level.value_or(0), attributes.has_walls};
  for (const Polygon2& polygon : projected.polygons)
    for_each_ring(polygon, [&](const Ring2& ring) {
      for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { stand.edges.push_back({a.x(), a.y(), b.x(), b.y()}); });
    });
  std::ranges::sort(stand.edges);
  return stand;
}

/// The first is to stay.
auto precedence_of(const Footprint& footprint) {
  return std::tuple(-footprint.attributes.height_m.value_or(0), -footprint.attributes.levels.value_or(0), footprint.id);
}

void keep_first(std::vector<std::uint32_t>& same, ProjectedFootprints& footprints, Diagnostics& diagnostics) {
  std::ranges::stable_sort(same, {}, [&](std::uint32_t i) { return precedence_of(footprints[i].footprint); });
  const std::string kept = footprints[same.front()].footprint.id;
  for (const std::uint32_t i : std::span(same).subspan(1)) {
    ProjectedFootprint repeated = footprints[i];
    diagnostics.set_rank(i + 1);
    diagnostics.add(DiagnosticCode::repeated_outline, repeated.footprint.id, "has the outline of " + kept + "; left out");
    repeated.polygons.clear();
    footprints.put(i, repeated);
  }
}

}  // namespace

void leave_out_repeated(ProjectedFootprints& footprints, Diagnostics& diagnostics) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < footprints.size(); ++i)
    if (!footprints.is_empty(i)) order.push_back(i);
  const auto place_of = [&](std::uint32_t i) { return std::pair(order_of(footprints.bounds(i)), footprints.kind(i)); };
  std::ranges::stable_sort(order, {}, place_of);
  for (auto first = order.begin(); first != order.end();) {   // few share their bounds: the rest need not be unpacked
    const auto end = std::find_if(first + 1, order.end(), [&, place = place_of(*first)](std::uint32_t i) { return place_of(i) != place; });
    if (end - first > 1) {
      std::map<Stand, std::vector<std::uint32_t>> by_stand;
      for (const std::uint32_t i : std::span(first, end)) by_stand[stand_of(footprints[i])].push_back(i);
      for (auto& [stand, same] : by_stand)
        if (same.size() > 1) keep_first(same, footprints, diagnostics);
    }
    first = end;
  }
}

}  // namespace priormap
