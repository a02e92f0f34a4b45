#include <priormap/evaluation/evaluate.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include <priormap/core/error.hpp>
#include <priormap/evaluation/association.hpp>
#include <priormap/evaluation/common_frame.hpp>
#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/transformer.hpp>

#include "turned_frames.hpp"

namespace priormap {
namespace {

void require_comparable(const Trajectory& reference, const Trajectory& estimate, Alignment align) {
  for (const auto& [trajectory, name] : {std::pair{&reference, "reference"}, {&estimate, "estimate"}})
    if (trajectory->size() == 0) throw FormatError(std::string("the ") + name + " holds no poses");
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

/// Where a trajectory begins, for people.
std::string place_of(const Trajectory& trajectory) {
  const Eigen::Vector3d p = trajectory.poses.front().translation();
  char text[96];
  if (trajectory.crs.empty()) {
    std::snprintf(text, sizeof text, "%.0f, %.0f m in a local frame", p.x(), p.y());
  } else {
    const Crs crs = Crs::parse(trajectory.crs);
    const Eigen::Vector3d lon_lat = Transformer(crs.horizontal(), crs.geographic_base()).forward(p);
    std::snprintf(text, sizeof text, "longitude %.4f, latitude %.4f", lon_lat.x(), lon_lat.y());
  }
  return text;
}

/// Distance of the boxes around two trajectories; infinity where coordinates lie out of reach of a CRS.
double gap_m(const Trajectory& reference, const Trajectory& estimate) {
  Eigen::AlignedBox3d box_of_reference, box_of_estimate;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Eigen::Vector3d p = reference.poses[i].translation(), q = estimate.poses[i].translation();
    if (!p.allFinite() || !q.allFinite()) return std::numeric_limits<double>::infinity();
    box_of_reference.extend(p);
    box_of_estimate.extend(q);
  }
  return box_of_reference.exteriorDistance(box_of_estimate);
}

/// Pairs that do not even come near each other are of different drives, or one is in another CRS than it says.
void require_a_common_place(const Trajectory& reference, const Trajectory& estimate, const Trajectory& stated_reference, const Trajectory& stated_estimate) {
  constexpr double usual_m = 1000;
  const double apart_m = gap_m(reference, estimate);
  if (apart_m <= path_lengths(reference).back() + usual_m) return;
  throw FormatError("reference and estimate share no place" + (std::isfinite(apart_m) ? ", they are " + std::to_string(std::lround(apart_m / 1000)) + " km apart" : "") +
                    ": the reference begins at " + place_of(stated_reference) + ", the estimate at " + place_of(stated_estimate) +
                    "; check that both are of one drive and the CRS of each (--crs), or lay them on each other with --align first|se3");
}

}  // namespace

TrajectoryEvaluation evaluate_trajectory(Trajectory reference, Trajectory estimate, const EvaluationOptions& options, const Events& events) {
  require_comparable(reference, estimate, options.align);
  TrajectoryEvaluation evaluation;
  evaluation.reference_poses = reference.size();
  evaluation.estimate_poses = estimate.size();

  const Trajectory stated_reference = select(reference, {0}), stated_estimate = select(estimate, {0});
  to_common_frame(reference, estimate);
  keep_pairs(reference, estimate, options.max_time_diff_s);
  if (options.align == Alignment::none) require_a_common_place(reference, estimate, stated_reference, stated_estimate);
  if (options.align == Alignment::none) warn_of_turned_frames(reference, estimate, events);
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
