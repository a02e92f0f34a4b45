#pragma once
#include <Eigen/Core>
#include <vector>

#include "polyline.hpp"

namespace priormap {

/// Where a car stands and which way it looks, yaw counter-clockwise from east without jumps of a full turn.
struct CarState {
  Eigen::Vector2d position;
  double yaw;
  bool backward;   ///< it came here in reverse
};

constexpr double turning_radius_m = 5;

/// A line as a car drives it, a state after every `step_m` of its way (a little less in a turn of three strokes): on the right-hand lane, never
/// tighter than its turning circle; where the line turns back it turns in three strokes, short of the street's end.
std::vector<CarState> steer_along(const Polyline& line, double lane_offset_m, double step_m);

}  // namespace priormap
