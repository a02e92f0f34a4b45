#include "shift_scores.hpp"

#include <algorithm>
#include <functional>

namespace priormap {
namespace {

constexpr double step_m = 0.15;
constexpr int steps = 6;   // each way
constexpr std::size_t at_rest = 2 * steps * (steps + 1);   // of the shifts, the middle one

/// Beyond which nothing was compared.
bool is_at_the_rim(const Eigen::Vector2d& shift_m) { return shift_m.cwiseAbs().maxCoeff() > (steps - 0.5) * step_m; }

}  // namespace

const std::vector<Eigen::Vector2d>& ShiftScores::shifts() {
  static const std::vector<Eigen::Vector2d> all = [] {
    std::vector<Eigen::Vector2d> shifts;
    for (int x = -steps; x <= steps; ++x)
      for (int y = -steps; y <= steps; ++y) shifts.emplace_back(step_m * x, step_m * y);
    return shifts;
  }();
  return all;
}

void ShiftScores::add(std::size_t index, std::size_t count, std::span<const double> improvements, std::size_t num_surfels) {
  std::vector<double>& part = parts_[index * num_parts / count];
  part.resize(improvements.size());
  std::ranges::transform(part, improvements, part.begin(), std::plus());
  num_surfels_ += num_surfels;
}

double ShiftScores::sum(std::size_t shift, std::size_t part_left_out) const {
  double sum = 0;
  for (std::size_t p = 0; p < num_parts; ++p)
    if (p != part_left_out && !parts_[p].empty()) sum += parts_[p][shift];
  return sum;
}

std::size_t ShiftScores::best_without(std::size_t part) const {
  std::size_t best = at_rest;
  for (std::size_t i = 0; i < shifts().size(); ++i)
    if (sum(i, part) > sum(best, part)) best = i;
  return best;
}

std::optional<Eigen::Vector2d> ShiftScores::clear() const {
  constexpr double least_m = 0.2, most_apart_m = 0.25;
  constexpr double least_gain = 0.0018;   // a surfel; where drives are right, chance gained up to 0.0014
  const std::size_t best = best_without(num_parts);
  const Eigen::Vector2d& shift_m = shifts()[best];
  if (shift_m.norm() < least_m || is_at_the_rim(shift_m) || sum(best, num_parts) - sum(at_rest, num_parts) < least_gain * static_cast<double>(num_surfels_)) return std::nullopt;
  for (std::size_t part = 0; part < num_parts; ++part)
    if ((shifts()[best_without(part)] - shift_m).norm() > most_apart_m) return std::nullopt;
  return shift_m;
}

}  // namespace priormap
