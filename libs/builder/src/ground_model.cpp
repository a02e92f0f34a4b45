#include <priormap/builder/ground_model.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace priormap {

GroundModel::GroundModel(std::optional<HeightRaster> terrain, std::optional<double> constant_m, std::optional<Transformer> constant_to_prior)
    : terrain_(std::move(terrain)), constant_m_(constant_m), constant_to_prior_(std::move(constant_to_prior)) {
  if (terrain_) step_m_ = std::max(1.0, 0.5 * terrain_->cell_size());
}

std::optional<double> GroundModel::at(const Eigen::Vector2d& place) const {
  if (terrain_)
    if (const std::optional<double> z = terrain_->at(place.x(), place.y())) return z;
  if (!constant_m_) return std::nullopt;
  if (!constant_to_prior_) return constant_m_;
  const double z = constant_to_prior_->forward({place.x(), place.y(), *constant_m_}).z();
  return std::isfinite(z) ? std::optional(z) : std::nullopt;
}

std::optional<GroundModel::Under> GroundModel::under(std::span<const Polygon2> polygons) const {
  if (!terrain_) {
    const std::optional<double> z = at(polygons.front().exterior.front());
    return z ? std::optional(Under{*z, *z}) : std::nullopt;
  }
  std::vector<double> heights;
  for (const Polygon2& polygon : polygons)
    for_each_ring(polygon, [&](const Ring2& ring) {
      for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        const int n = std::max(1, static_cast<int>(std::ceil((b - a).norm() / step_m_)));
        for (int i = 0; i < n; ++i)
          if (const std::optional<double> z = at(a + (b - a) * (static_cast<double>(i) / n))) heights.push_back(*z);
      });
    });
  if (heights.empty()) return std::nullopt;
  std::ranges::sort(heights);
  return Under{heights.front(), 0.5 * (heights[(heights.size() - 1) / 2] + heights[heights.size() / 2])};
}

}  // namespace priormap
