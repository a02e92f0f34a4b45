#pragma once
#include <cstddef>
#include <vector>

#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// Positions in the two trajectories of one moment.
struct PosePair {
  std::size_t reference = 0;
  std::size_t estimate = 0;
};

/// By scan index where both have indices, else by stamp where both have stamps, else line by line. Indices that count apart, since stamps that agree on the first pair do not agree on all and pair no fewer poses, are not heard.
/// By stamp: each estimate takes the reference nearest in time within `max_time_diff_s`, none is taken twice (the nearer estimate wins).
/// Pairs are in order of the estimate. Empty when nothing fits.
std::vector<PosePair> associate(const Trajectory& reference, const Trajectory& estimate, double max_time_diff_s);

/// The two trajectories cut down to the pairs, equally long.
Trajectory select(const Trajectory& trajectory, const std::vector<std::size_t>& which);

}  // namespace priormap
