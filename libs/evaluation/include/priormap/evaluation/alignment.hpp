#pragma once
#include <Eigen/Geometry>
#include <string>

#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// none: as they are. first: the first poses are laid on each other. se3, sim3: least squares over all positions
/// (Umeyama, PAMI 1991), without and with a scale.
enum class Alignment { none, first, se3, sim3 };

/// @throws UsageError for another word than none, first, se3, sim3.
Alignment alignment(const std::string& word);

/// p_reference = scale * (rotation p_estimate) + translation.
struct Similarity {
  Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();
  double scale = 1;
};

/// Trajectories of equal length, paired by position.
/// @throws FormatError when se3 or sim3 have fewer than three pairs, or sim3 finds no motion in the estimate.
Similarity find_alignment(const Trajectory& reference, const Trajectory& estimate, Alignment alignment);

void apply_alignment(Trajectory& estimate, const Similarity& similarity);

}  // namespace priormap
