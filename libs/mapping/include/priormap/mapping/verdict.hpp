#pragma once
#include <Eigen/Core>
#include <string>

namespace priormap {

/// What a pose rests on.
enum class Verdict {
  anchored,        ///< the prior holds it in every direction
  weak,            ///< the prior holds it, but not in every direction to half a metre (one standard deviation)
  dead_reckoned,   ///< there is a prior, but it did not match here, or its walls are not where the scans see walls: odometry since the last anchored pose
  outside_prior,   ///< no prior here: odometry
  lost,            ///< neither prior nor local map matched: the motion was carried on
};

/// As written to trajectory.csv and run.json: "dead-reckoned".
std::string to_string(Verdict verdict);

struct MappedScan;
/// Takes back what matching alone said of a scan that is placed: dead-reckoned, where contradicted; weak, and in which direction, by its covariance.
/// @param by_covariance  false: the covariance is not one to tell weak from anchored by, only the direction
void judge(MappedScan& scan, bool by_covariance);

/// As written to trajectory.csv and run.json: "up", or degrees clockwise from the north of the frame, "000" to "179". @param axis  unit vector; empty for zero
std::string direction_text(const Eigen::Vector3d& axis);

}  // namespace priormap
