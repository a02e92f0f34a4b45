#include "merge/distant_priors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace priormap {
namespace {

constexpr double usual_m = 50'000;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The rectangle around all tiles, in the merged prior's CRS; empty where that cannot be told.
Bounds2 extent(const PriorStore& prior, const std::optional<Transformer>& transformer) {
  const TileGrid grid(prior.manifest().tile_size);
  Bounds2 all{infinity, infinity, -infinity, -infinity};
  const auto include = [&all](double x, double y) { all = {std::min(all.min_x, x), std::min(all.min_y, y), std::max(all.max_x, x), std::max(all.max_y, y)}; };
  for (const TileEntry& tile : prior.tiles()) {
    const Bounds2 bounds = grid.bounds(tile.key);
    include(bounds.min_x, bounds.min_y);
    include(bounds.max_x, bounds.max_y);
  }
  if (all.empty() || !transformer) return all;
  std::vector<Eigen::Vector3d> corners;
  for (const double x : {all.min_x, all.max_x})
    for (const double y : {all.min_y, all.max_y}) corners.emplace_back(x, y, 0);
  Transformer(*transformer).forward(corners);
  all = {infinity, infinity, -infinity, -infinity};
  for (const Eigen::Vector3d& corner : corners)
    if (corner.allFinite()) include(corner.x(), corner.y());
  return all;
}

double distance(const Bounds2& a, const Bounds2& b) {
  return std::hypot(std::max({0.0, a.min_x - b.max_x, b.min_x - a.max_x}), std::max({0.0, a.min_y - b.max_y, b.min_y - a.max_y}));
}

}  // namespace

void warn_of_distant_priors(std::span<const PriorStore> priors, const CommonCrs& crs, const Events& events) {
  std::vector<Bounds2> extents;
  for (std::size_t i = 0; i < priors.size(); ++i) extents.push_back(extent(priors[i], crs.steps[i].transformer));
  std::vector<double> to_reached_m(priors.size(), infinity);
  std::vector<bool> reached(priors.size());
  for (std::size_t next = 0;;) {
    reached[next] = true;
    std::size_t nearest = next;
    for (std::size_t i = 0; i < priors.size(); ++i) {
      if (reached[i] || extents[i].empty()) continue;
      if (!extents[next].empty()) to_reached_m[i] = std::min(to_reached_m[i], distance(extents[i], extents[next]) * crs.horizontal_unit_m);
      if (reached[nearest] || to_reached_m[i] < to_reached_m[nearest]) nearest = i;
    }
    if (reached[nearest] || !std::isfinite(to_reached_m[nearest])) return;
    if (to_reached_m[nearest] > usual_m)
      return events.warn(priors[nearest].directory().string() + ": lies " + std::to_string(std::lround(to_reached_m[nearest] / 1000)) +
                         " km from what it is merged with; is it of the same place? priorinfo says where a prior lies");
    next = nearest;
  }
}

}  // namespace priormap
