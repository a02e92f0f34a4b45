#pragma once
#include <priormap/core/events.hpp>
#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// Warns when the paired poses of two trajectories fit far better after a turn: one is in the axes of a camera, say, and the other in those of a LiDAR or a map.
void warn_of_turned_frames(const Trajectory& reference, const Trajectory& estimate, const Events& events);

}  // namespace priormap
