#include "prior_comparison.hpp"

#include <algorithm>
#include <span>

#include "shift_scores.hpp"

namespace priormap {
namespace {

/// Planes are known beyond what is compared, as far as what is compared may lie from them.
double reach_m(const JointMethodOptions& options) {
  constexpr double least_margin_m = 5;
  return options.estimate.range_m + PriorComparison::together_m + std::max(least_margin_m, options.tracking.registration.max_distance_m);
}

JointOptions one_step(JointOptions options) {
  options.max_iterations = 1;
  return options;
}

}  // namespace

PriorComparison::PriorComparison(const NearTiles& prior, const PiecesOfPrior& pieces, const JointMethodOptions& options)
    : window_(NearTiles(prior.points(), prior.frame(), reach_m(options), prior.threads()), PriorSurfels(options.tracking.prior),
              [&pieces](PatchCloud& patches) { pieces.move_buildings(patches); }),
      registrations_([how = one_step(options.tracking.registration)] { return JointRegistration(how); }) {}

std::vector<PlaneMatch> PriorComparison::at(const SurfelCloud& surfels, const Eigen::Isometry3d& T_map_sensor) {
  return registrations_.with_one([&](JointRegistration& registration) {
    const auto targets = window_.map().targets(0.0, PriorSurfels::unweighted);
    registration.align(surfels, targets, T_map_sensor);
    std::vector<PlaneMatch> matches;
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const std::vector<PlaneMatch> layer = registration.plane_matches(t);
      matches.insert(matches.end(), layer.begin(), layer.end());
    }
    return matches;
  });
}

std::vector<double> PriorComparison::improvements(const SurfelCloud& surfels, const Eigen::Isometry3d& T_map_sensor) {
  constexpr double sigma_m = 0.2;
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Vector2d& shift_m : ShiftScores::shifts()) poses.push_back(Eigen::Translation3d(shift_m.x(), shift_m.y(), 0) * T_map_sensor);
  return registrations_.with_one([&](JointRegistration& registration) {
    const auto targets = window_.map().targets(0.0, PriorSurfels::unweighted);
    return registration.improvements(surfels, std::span(targets).subspan(PriorSurfels::of_the_rest, 1), T_map_sensor, poses, sigma_m);
  });
}

}  // namespace priormap
