#pragma once
#include <string>

namespace priormap {

/// What a pose rests on.
enum class Verdict {
  anchored,        ///< the prior holds it in every direction
  weak,            ///< the prior holds it, but not in every direction
  dead_reckoned,   ///< there is a prior, but it did not match here: odometry since the last anchored pose
  outside_prior,   ///< no prior here: odometry
  lost,            ///< neither prior nor local map matched: the motion was carried on
};

/// As written to trajectory.csv and run.json: "dead-reckoned".
std::string to_string(Verdict verdict);

}  // namespace priormap
