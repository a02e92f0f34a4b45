#pragma once
#include <cstddef>
#include <string>

#include <priormap/core/events.hpp>
#include <priormap/core/option_field.hpp>
#include <priormap/evaluation/absolute_error.hpp>
#include <priormap/evaluation/alignment.hpp>
#include <priormap/evaluation/relative_error.hpp>
#include <priormap/evaluation/segment_error.hpp>
#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

struct EvaluationOptions {
  Alignment align = Alignment::none;
  double max_time_diff_s = 0.01;
  double rpe_delta_m = 10;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("max-time-diff", max_time_diff_s, OptionField{"poses farther apart in time are not paired", "s", 0, 1e9});
    visit("rpe-delta", rpe_delta_m, OptionField{"length of the stretches of the relative error", "m", 1e-3, 1e6});
  }
};

struct TrajectoryEvaluation {
  std::size_t reference_poses = 0, estimate_poses = 0, pairs = 0;
  double reference_length_m = 0;      ///< over the paired poses
  Similarity alignment;
  AbsoluteError ate;
  SegmentError rte;
  RelativeError rpe;
  double rpe_delta_m = 0;
};

/// Compares an estimate with a reference: common frame, association, alignment, then the three measures.
/// Warns when poses stay without a partner, and when nothing is aligned though a turn would make the error far smaller.
/// @throws CrsError as to_common_frame, and when one side is georeferenced, the other is not and nothing is aligned;
/// FormatError when one side holds no poses, when no pose has a partner, when nothing is aligned and the two stay farther apart than the reference's way and 1 km, or as find_alignment.
TrajectoryEvaluation evaluate_trajectory(Trajectory reference, Trajectory estimate, const EvaluationOptions& options, const Events& events);

/// For people: a few lines. For machines: one JSON object; lengths in m, angles in degrees.
std::string to_text(const TrajectoryEvaluation& evaluation);
std::string to_json(const TrajectoryEvaluation& evaluation);

}  // namespace priormap
