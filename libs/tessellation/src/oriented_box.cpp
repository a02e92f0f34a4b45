#include <algorithm>
#include <limits>

#include "roof_kinds.hpp"

namespace priormap {

OrientedBox oriented_box(const Ring2& ring) {
  OrientedBox best;
  double least = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d anchor = ring.front();
  for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double length = (b - a).norm();
    if (!(length > 0)) return;
    const Eigen::Vector2d along = (b - a) / length, across(-along.y(), along.x());
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Eigen::Vector2d& p : ring) {
      const Eigen::Vector2d local(along.dot(p - anchor), across.dot(p - anchor));
      low = low.cwiseMin(local);
      high = high.cwiseMax(local);
    }
    const Eigen::Vector2d half = 0.5 * (high - low), middle = 0.5 * (low + high);
    if (half.x() * half.y() >= least * (1 - 1e-9)) return;
    least = half.x() * half.y();
    best = {anchor + along * middle.x() + across * middle.y(), along, across, half.x(), half.y()};
  });
  if (best.half_width > best.half_length) {
    std::swap(best.half_length, best.half_width);
    best = {best.center, best.across, -best.along, best.half_length, best.half_width};
  }
  return best;
}

}  // namespace priormap
