#include <priormap/evaluation/association.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>

namespace priormap {
namespace {

std::vector<PosePair> by_index(const Trajectory& reference, const Trajectory& estimate) {
  std::unordered_map<std::int64_t, std::size_t> position_of;
  for (std::size_t i = 0; i < reference.size(); ++i) position_of.emplace(reference.indices[i], i);
  std::vector<PosePair> pairs;
  for (std::size_t k = 0; k < estimate.size(); ++k)
    if (const auto found = position_of.find(estimate.indices[k]); found != position_of.end()) pairs.push_back({found->second, k});
  return pairs;
}

std::size_t nearest(const std::vector<double>& sorted, double value) {
  const auto after = std::lower_bound(sorted.begin(), sorted.end(), value);
  if (after == sorted.begin()) return 0;
  const auto before = after - 1;
  return static_cast<std::size_t>((after == sorted.end() || value - *before <= *after - value ? before : after) - sorted.begin());
}

std::vector<PosePair> by_stamp(const Trajectory& reference, const Trajectory& estimate, double max_time_diff_s) {
  std::map<std::size_t, std::size_t> estimate_of;   // reference -> the estimate nearest to it in time
  const auto gap = [&](std::size_t r, std::size_t k) { return std::abs(reference.stamps_s[r] - estimate.stamps_s[k]); };
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    const std::size_t r = nearest(reference.stamps_s, estimate.stamps_s[k]);
    if (gap(r, k) > max_time_diff_s) continue;
    const auto [taken, is_new] = estimate_of.emplace(r, k);
    if (!is_new && gap(r, k) < gap(r, taken->second)) taken->second = k;
  }
  std::vector<PosePair> pairs;
  for (const auto& [r, k] : estimate_of) pairs.push_back({r, k});
  return pairs;
}

/// Where two clocks agree on the first pair but not on all, a scan is missing from one of the recordings, whose indices go on without it.
bool indices_count_apart(const Trajectory& reference, const Trajectory& estimate, const std::vector<PosePair>& pairs, double max_time_diff_s) {
  if (reference.stamps_s.empty() || estimate.stamps_s.empty() || pairs.empty()) return false;
  const auto agree = [&](const PosePair& pair) { return std::abs(reference.stamps_s[pair.reference] - estimate.stamps_s[pair.estimate]) <= max_time_diff_s; };
  return agree(pairs.front()) && !std::all_of(pairs.begin(), pairs.end(), agree);
}

std::vector<PosePair> by_line(const Trajectory& reference, const Trajectory& estimate) {
  std::vector<PosePair> pairs(std::min(reference.size(), estimate.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {i, i};
  return pairs;
}

}  // namespace

std::vector<PosePair> associate(const Trajectory& reference, const Trajectory& estimate, double max_time_diff_s) {
  if (!reference.indices.empty() && !estimate.indices.empty()) {
    std::vector<PosePair> pairs = by_index(reference, estimate);
    if (!indices_count_apart(reference, estimate, pairs, max_time_diff_s)) return pairs;
    std::vector<PosePair> by_time = by_stamp(reference, estimate, max_time_diff_s);
    return by_time.size() < pairs.size() ? pairs : by_time;   // fewer: the clocks merely jitter
  }
  if (!reference.stamps_s.empty() && !estimate.stamps_s.empty()) return by_stamp(reference, estimate, max_time_diff_s);
  return by_line(reference, estimate);
}

Trajectory select(const Trajectory& trajectory, const std::vector<std::size_t>& which) {
  Trajectory selected{.stamps_s = {}, .indices = {}, .poses = {}, .crs = trajectory.crs};
  for (const std::size_t i : which) {
    if (!trajectory.stamps_s.empty()) selected.stamps_s.push_back(trajectory.stamps_s[i]);
    if (!trajectory.indices.empty()) selected.indices.push_back(trajectory.indices[i]);
    selected.poses.push_back(trajectory.poses[i]);
  }
  return selected;
}

}  // namespace priormap
