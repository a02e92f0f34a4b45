#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "roof_kinds.hpp"

namespace priormap {
namespace {

/// From the eaves to the top: share of the outline's size, share of the rise.
using Profile = std::vector<std::array<double, 2>>;

Profile profile_of(RoofShape shape, double run_m, double rise_m) {
  if (shape == RoofShape::onion)
    return {{1, 0}, {0.8, 0}, {0.95, 0.12}, {1, 0.25}, {0.9, 0.4}, {0.65, 0.55}, {0.4, 0.68}, {0.2, 0.82}, {0.08, 0.92}, {0, 1}};
  if (shape == RoofShape::dome) {
    constexpr double facet_m = 1;
    const int facets = std::clamp(static_cast<int>(std::ceil(0.5 * std::numbers::pi * std::max(run_m, rise_m) / facet_m)), 3, 16);
    Profile arc;
    for (int i = 0; i < facets; ++i) {
      const double angle = 0.5 * std::numbers::pi * i / facets;
      arc.push_back({std::cos(angle), std::sin(angle)});
    }
    arc.push_back({0, 1});
    return arc;
  }
  return {{1, 0}, {0, 1}};
}

Eigen::Vector2d centroid(const Ring2& ring) {
  const Eigen::Vector2d anchor = ring.front();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double twice_area = 0;
  for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d p = a - anchor, q = b - anchor;
    const double cross = p.x() * q.y() - p.y() * q.x();
    sum += cross * (p + q);
    twice_area += cross;
  });
  return anchor + sum / (3 * twice_area);
}

}  // namespace

double radial_run_m(const Polygon2& outline) {
  if (!outline.holes.empty()) return 0;
  const Eigen::Vector2d center = centroid(outline.exterior);
  double nearest = std::numeric_limits<double>::infinity();
  for_each_edge(outline.exterior, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d along = (b - a).normalized(), to_center = center - a;
    nearest = std::min(nearest, along.x() * to_center.y() - along.y() * to_center.x());
  });
  return std::max(0.0, nearest);
}

std::optional<Roof> radial_roof(const Polygon2& outline, double eaves_z, const RoofSpec& spec) {
  const double run_m = radial_run_m(outline);
  if (!(run_m > 0)) return std::nullopt;
  const Eigen::Vector2d center = centroid(outline.exterior);
  const Profile profile = profile_of(spec.shape, run_m, spec.rise_m);
  const auto at = [&](const Eigen::Vector2d& p, const std::array<double, 2>& level) {
    const Eigen::Vector2d q = center + level[0] * (p - center);
    return Eigen::Vector3d(q.x(), q.y(), eaves_z + level[1] * spec.rise_m);
  };

  Roof roof;
  roof.wall_tops = level_wall_tops(outline, eaves_z);
  for (std::size_t k = 0; k + 1 < profile.size(); ++k)
    for_each_edge(outline.exterior, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      Polygon3 face{{at(a, profile[k]), at(b, profile[k]), at(b, profile[k + 1])}, {}};
      if (profile[k + 1][0] > 0) face.exterior.push_back(at(a, profile[k + 1]));
      roof.faces.push_back(std::move(face));
    });
  return roof;
}

}  // namespace priormap
