#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>

#include <priormap/geodesy/interpolated_transformer.hpp>
#include <priormap/tessellation/normalize.hpp>

#include "chunks.hpp"
#include "outline_stages.hpp"
#include "repeated_outlines.hpp"

namespace priormap {
namespace {

constexpr std::size_t chunk_size = 512;
constexpr double longest_building_m = 5000, largest_building_m2 = 10e6;

/// Directions from true north become directions from the grid's.
void turn_roof_directions(std::span<Footprint> footprints, InterpolatedTransformer& transformer) {
  if (!transformer.exact().source().is_geographic()) return;
  constexpr double step_deg = 1e-4;
  for (Footprint& footprint : footprints) {
    std::optional<double>& direction_deg = footprint.attributes.roof_direction_deg;
    if (!direction_deg || footprint.rings.empty()) continue;
    const Eigen::Vector2d& place = footprint.rings.front().front();
    std::array<Eigen::Vector3d, 2> northward{{{place.x(), place.y() - step_deg, 0}, {place.x(), place.y() + step_deg, 0}}};
    transformer.apply(northward);
    const Eigen::Vector3d north = northward[1] - northward[0];
    const double turned_deg = *direction_deg + std::atan2(north.x(), north.y()) * 180 / std::numbers::pi;
    direction_deg = turned_deg - 360 * std::floor(turned_deg / 360);
  }
}

/// All rings of a stretch of footprints at once.
void transform(std::span<Footprint> footprints, InterpolatedTransformer& transformer) {
  std::vector<Eigen::Vector3d> points;
  for (const Footprint& footprint : footprints)
    for (const Ring2& ring : footprint.rings)
      for (const Eigen::Vector2d& p : ring) points.emplace_back(p.x(), p.y(), 0);
  transformer.apply(points);
  auto next = points.begin();
  for (Footprint& footprint : footprints)
    for (Ring2& ring : footprint.rings)
      for (Eigen::Vector2d& p : ring) p = (next++)->head<2>();
}

void transform_by_file(std::span<Footprint> footprints, std::vector<InterpolatedTransformer>& transformers) {
  while (!footprints.empty()) {
    const std::uint16_t file = footprints.front().file;
    const auto other = std::ranges::find_if(footprints, [&](const Footprint& footprint) { return footprint.file != file; });
    const auto count = static_cast<std::size_t>(other - footprints.begin());
    turn_roof_directions(footprints.first(count), transformers[file]);
    transform(footprints.first(count), transformers[file]);
    footprints = footprints.subspan(count);
  }
}

bool is_finite(const std::vector<Ring2>& rings) {
  for (const Ring2& ring : rings)
    for (const Eigen::Vector2d& p : ring)
      if (!p.allFinite()) return false;
  return true;
}

/// What no building is, but a wrong digit makes: points for it would fill the memory.
bool is_implausible(const ProjectedFootprint& projected) {
  double size = 0;
  for (const Polygon2& polygon : projected.polygons) size += area(polygon);
  const Bounds2& b = projected.bounds;
  return !projected.polygons.empty() && !(std::max(b.max_x - b.min_x, b.max_y - b.min_y) <= longest_building_m && size <= largest_building_m2);
}

ProjectedFootprint in_order(Footprint&& footprint, Diagnostics& diagnostics) {
  ProjectedFootprint projected{{}, {}, {}};
  if (is_finite(footprint.rings))
    projected.polygons = normalize(footprint.rings, footprint.id, diagnostics);
  else
    diagnostics.add(DiagnosticCode::degenerate_geometry, footprint.id, "lies outside the domain of the prior's CRS; left out");
  Ring2 corners;
  for (const Polygon2& polygon : projected.polygons) {
    const Bounds2 b = bounds_of(polygon.exterior);
    corners.insert(corners.end(), {{b.min_x, b.min_y}, {b.max_x, b.max_y}});
  }
  projected.bounds = bounds_of(corners);
  if (is_implausible(projected)) {
    diagnostics.add(DiagnosticCode::implausible_size, footprint.id, "larger than any building; left out");
    projected.polygons.clear();
  }
  footprint.rings.clear();
  projected.footprint = std::move(footprint);
  return projected;
}

}  // namespace

ProjectedFootprints project_footprints(const FootprintList& footprints, const std::vector<Transformer>& prior_from_outlines, int threads, Diagnostics& diagnostics) {
  ProjectedFootprints projected(footprints.size());
  std::mutex mutex;
  for_each_chunk(
      footprints.size(), chunk_size, threads, [&] { return std::vector<InterpolatedTransformer>(prior_from_outlines.begin(), prior_from_outlines.end()); },
      [&](std::vector<InterpolatedTransformer>& transformers, std::size_t, std::size_t begin, std::size_t end) {
        std::vector<Footprint> some;
        for (std::size_t i = begin; i < end; ++i) some.push_back(footprints[i]);
        transform_by_file(some, transformers);
        Diagnostics found;
        for (std::size_t i = begin; i < end; ++i) {
          found.set_rank(i + 1);
          projected.put(i, in_order(std::move(some[i - begin]), found));
        }
        const std::lock_guard lock(mutex);
        diagnostics.merge(found);
      });
  leave_out_repeated(projected, diagnostics);
  projected.sort();
  return projected;
}

}  // namespace priormap
