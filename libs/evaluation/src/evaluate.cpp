#include <priormap/evaluation/evaluate.hpp>

#include <priormap/core/error.hpp>
#include <priormap/evaluation/association.hpp>
#include <priormap/evaluation/common_frame.hpp>

namespace priormap {
namespace {

void require_comparable(const Trajectory& reference, const Trajectory& estimate, Alignment align) {
  if (reference.crs.empty() == estimate.crs.empty() || align != Alignment::none) return;
  const std::string georeferenced = reference.crs.empty() ? "estimate" : "reference";
  throw CrsError("only the " + georeferenced + " is georeferenced (" + reference.crs + estimate.crs +
                 "), the other is in a local metric frame; give that one's CRS with --crs, or lay them on each other with --align first|se3");
}

void keep_pairs(Trajectory& reference, Trajectory& estimate, double max_time_diff_s) {
  std::vector<std::size_t> of_reference, of_estimate;
  for (const PosePair& pair : associate(reference, estimate, max_time_diff_s)) {
    of_reference.push_back(pair.reference);
    of_estimate.push_back(pair.estimate);
  }
  if (of_reference.empty())
    throw FormatError("no pose of the estimate has a partner in the reference; do both come from the same drive (see --max-time-diff)?");
  reference = select(reference, of_reference);
  estimate = select(estimate, of_estimate);
}

}  // namespace

TrajectoryEvaluation evaluate_trajectory(Trajectory reference, Trajectory estimate, const EvaluationOptions& options, const Events& events) {
  require_comparable(reference, estimate, options.align);
  TrajectoryEvaluation evaluation;
  evaluation.reference_poses = reference.size();
  evaluation.estimate_poses = estimate.size();

  to_common_frame(reference, estimate);
  keep_pairs(reference, estimate, options.max_time_diff_s);
  evaluation.pairs = reference.size();
  if (evaluation.pairs < evaluation.estimate_poses)
    events.warn(std::to_string(evaluation.estimate_poses - evaluation.pairs) + " of " + std::to_string(evaluation.estimate_poses) +
                " estimated poses have no partner in the reference and are left out");

  evaluation.alignment = find_alignment(reference, estimate, options.align);
  apply_alignment(estimate, evaluation.alignment);

  evaluation.reference_length_m = path_lengths(reference).back();
  evaluation.ate = absolute_error(reference, estimate);
  evaluation.rte = segment_error(reference, estimate);
  evaluation.rpe = relative_error(reference, estimate, options.rpe_delta_m);
  evaluation.rpe_delta_m = options.rpe_delta_m;
  return evaluation;
}

}  // namespace priormap
