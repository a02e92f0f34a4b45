#pragma once
#include <vector>

#include <priormap/builder/bbox_filter.hpp>
#include <priormap/builder/line_of_sight.hpp>
#include <priormap/builder/sight_options.hpp>

namespace priormap {

/// Calls visit(point, normal) for those of a building's points that lie inside --bbox and can be seen. @param sight  none: all count as seen
template <class Visit>
SightCounts for_each_visible(const FacePoints& points, const BboxFilter& bbox, const LineOfSight* sight, LineOfSight::Skin skin, const Visit& visit) {
  const std::vector<bool> seen = sight ? sight->seen(points, skin) : std::vector<bool>();
  SightCounts counts;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const Eigen::Vector3d& p = points.points[i];
    if (bbox.is_active() && !bbox.contains(p.x(), p.y())) continue;
    ++counts.sampled;
    if (sight && !seen[i])
      ++counts.out_of_sight;
    else
      visit(p, points.normals[i]);
  }
  return counts;
}

}  // namespace priormap
