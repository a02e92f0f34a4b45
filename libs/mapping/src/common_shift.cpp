#include "common_shift.hpp"

#include <algorithm>

#include <priormap/core/parallel.hpp>

#include "shift_scores.hpp"

namespace priormap {

std::optional<Eigen::Vector2d> common_shift(const DriveGraph& graph, const std::vector<PoseId>& stretch, PriorComparison& comparison, ScansAgain& scans, int threads) {
  constexpr std::size_t least_scans = 8, most_scans = 20;
  const std::size_t count = std::min(stretch.size(), most_scans);
  if (count < least_scans) return std::nullopt;
  struct Improvements {
    std::vector<double> at_shifts;
    std::size_t num_surfels = 0;
  };
  std::vector<Improvements> found(count);
  const auto key = [&](std::size_t i) { return stretch[i * stretch.size() / count]; };
  const auto position = [&](std::size_t i) { return graph.pose(key(i)).translation(); };
  for (std::size_t first = 0, last = 1; first < count; first = last++) {
    while (last < count && (position(last) - position(first)).norm() <= PriorComparison::together_m) ++last;
    comparison.move_to(position(first));
    parallel_for(last - first, threads, [&](std::size_t j) {
      const std::size_t i = first + j;
      const auto surfels = scans.surfels_of(key(i), graph.record(key(i)));
      found[i] = {comparison.improvements(*surfels, graph.pose(key(i))), surfels->size()};
    });
  }
  ShiftScores scores;
  for (std::size_t i = 0; i < count; ++i) scores.add(i, count, found[i].at_shifts, found[i].num_surfels);
  return scores.clear();
}

}  // namespace priormap
