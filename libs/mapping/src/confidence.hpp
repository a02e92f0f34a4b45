#pragma once
#include <vector>

#include <priormap/core/se3.hpp>

namespace priormap {

/// How sure things are that no matching tells. Tangent [rotation, translation] in sensor axes.

/// A motion that is only the last one carried on: two degrees and half a metre.
Matrix6d carried_covariance();

/// A gap in the odometry of nobody knows how long: half a turn and a hundred metres.
Matrix6d unknown_gap_covariance();

/// The start that a user gives: well levelled, its height within a metre, its place within five metres and its direction within ten degrees.
Matrix6d start_information(const Eigen::Isometry3d& T_map_sensor);

/// By how much the height that a user gives for the start may differ from the prior's before one of both is taken to be wrong.
constexpr double usual_height_gap_m = 0.25;

/// Inverse of an information matrix. Directions that nothing constrains are as uncertain as can be, but finite.
Matrix6d covariance_of(const Matrix6d& information);

/// Of each keyframe: its covariance, and whether the prior is of another place there.
struct Confidence {
  std::vector<Matrix6d> covariances;
  std::vector<bool> contradicted;
};

/// Who was not found again is contradicted. Whom the prior contradicts around most places fits the others by chance: nowhere is it known where the drive is.
/// @param located  keyframes that were found in the prior; as many as `sure` holds
void doubt_what_is_contradicted(Confidence& sure, const std::vector<bool>& located);

}  // namespace priormap
