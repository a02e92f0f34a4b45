#include <priormap/evaluation/segment_error.hpp>

#include <algorithm>
#include <cstddef>

#include "relative_motion.hpp"
#include <priormap/evaluation/absolute_error.hpp>

namespace priormap {
namespace {

SegmentError segment_error(const Trajectory& reference, const Trajectory& estimate, double shortest_m) {
  constexpr std::size_t step = 10;
  constexpr int num_lengths = 8;
  const std::vector<double> path = path_lengths(reference);
  SegmentError result;
  for (int multiple = 1; multiple <= num_lengths; ++multiple) {
    const double length_m = multiple * shortest_m;
    const std::size_t before = result.segments;
    for (std::size_t first = 0; first < path.size(); first += step) {
      const auto last = std::upper_bound(path.begin(), path.end(), path[first] + length_m);
      if (last == path.end()) break;
      const Eigen::Isometry3d error = motion_error(reference, estimate, first, static_cast<std::size_t>(last - path.begin()));
      result.translation_ratio += error.translation().norm() / length_m;
      result.rotation_rad_per_m += rotation_angle(error.linear()) / length_m;
      ++result.segments;
    }
    if (result.segments > before) result.lengths_m.push_back(length_m);
  }
  if (result.segments > 0) {
    result.translation_ratio /= static_cast<double>(result.segments);
    result.rotation_rad_per_m /= static_cast<double>(result.segments);
  }
  return result;
}

}  // namespace

SegmentError segment_error(const Trajectory& reference, const Trajectory& estimate) {
  for (const double shortest_m : {100.0, 10.0}) {
    const SegmentError result = segment_error(reference, estimate, shortest_m);
    if (result.segments > 0) return result;
  }
  return segment_error(reference, estimate, 1.0);
}

}  // namespace priormap
