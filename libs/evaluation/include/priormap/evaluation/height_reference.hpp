#pragma once
#include <string>

#include <priormap/core/events.hpp>
#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// A trajectory and the file it is of, as messages name it.
struct TrajectoryOfFile {
  std::string file;
  Trajectory& trajectory;
};

/// Takes undeclared heights of a georeferenced trajectory as heights in the vertical CRS `assume_vertical` (may be empty) and sees to it that
/// declared and undeclared heights are not compared in silence: an estimate's undeclared ones beside a reference's declared ones are refused; the other way round
/// both are compared as they are, with a warning.
/// @throws CrsError where they are refused, and when `assume_vertical` is no vertical CRS
void settle_heights(const TrajectoryOfFile& reference, const TrajectoryOfFile& estimate, const std::string& assume_vertical, const Events& events);

}  // namespace priormap
