#pragma once
#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// Replaces projected coordinates by metric ones: both trajectories come into the MapFrame at the reference's first pose, because
/// a metre of a projected CRS is no metre and its north is not everybody's. An estimate in another CRS is transformed to the reference's first.
/// A trajectory beside a metric one comes into the MapFrame at its own first pose: then only an alignment makes the two comparable.
/// @throws CrsError when a CRS is unknown, geographic, or there is no exact operation between the two.
void to_common_frame(Trajectory& reference, Trajectory& estimate);

}  // namespace priormap
