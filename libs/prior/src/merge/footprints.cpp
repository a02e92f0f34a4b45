#include "merge/footprints.hpp"

#include <algorithm>

namespace priormap {

void Footprints::add(const Feature& feature) {
  for (const auto& outline : feature.outline) {
    InTile::Polygon polygon{{INT64_MAX, INT64_MAX}, {INT64_MIN, INT64_MIN}, {}};
    for (const auto& ring : outline) {
      polygon.rings.emplace_back();
      for (const Eigen::Vector2d& p : ring) {
        const InTile::Point q{to_lattice(p.x()), to_lattice(p.y())};
        polygon.rings.back().push_back(q);
        polygon.min = {std::min(polygon.min.x, q.x), std::min(polygon.min.y, q.y)};
        polygon.max = {std::max(polygon.max.x, q.x), std::max(polygon.max.y, q.y)};
      }
    }
    if (polygon.min.x > polygon.max.x) continue;
    const TileKey low = grid_.key(polygon.min.x - margin_, polygon.min.y - margin_);
    const TileKey high = grid_.key(polygon.max.x + margin_, polygon.max.y + margin_);
    for (TileKey key = low; key.x <= high.x; ++key.x)
      for (key.y = low.y; key.y <= high.y; ++key.y) polygons_of_tile_[key].push_back(std::uint32_t(polygons_.size()));
    polygons_.push_back(std::move(polygon));
  }
}

Footprints::InTile Footprints::in_tile(TileKey key) const {
  InTile result;
  const auto found = polygons_of_tile_.find(key);
  if (found == polygons_of_tile_.end()) return result;
  const std::int64_t origin_x = grid_.origin(key.x), origin_y = grid_.origin(key.y);
  const auto move = [&](InTile::Point& p) { p = {p.x - origin_x, p.y - origin_y}; };
  for (const std::uint32_t index : found->second) {
    InTile::Polygon& polygon = result.polygons_.emplace_back(polygons_[index]);
    move(polygon.min);
    move(polygon.max);
    for (auto& ring : polygon.rings) std::ranges::for_each(ring, move);
  }
  return result;
}

bool Footprints::InTile::contains(std::int32_t x, std::int32_t y) const {
  for (const Polygon& polygon : polygons_) {
    if (x < polygon.min.x || x > polygon.max.x || y < polygon.min.y || y > polygon.max.y) continue;
    bool inside = false;
    for (const auto& ring : polygon.rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point &a = ring[i], &b = ring[i + 1 == ring.size() ? 0 : i + 1];
        if ((a.y > y) == (b.y > y)) continue;
        // The ray to +x crosses the edge when the point lies left of it, seen upwards.
        const std::int64_t side = (b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y);
        if (b.y > a.y ? side > 0 : side < 0) inside = !inside;
      }
    if (inside) return true;
  }
  return false;
}

}  // namespace priormap
