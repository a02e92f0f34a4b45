#pragma once
#include <priormap/builder/projected_footprints.hpp>
#include <priormap/core/diagnostics.hpp>

namespace priormap {

/// Empties footprints of one kind that have the same rings, however listed, and start at the same height, but for one: it would give every point twice. What states
/// its height stays, of several the highest; else the first by id. The others are counted (707). What starts higher stands on the others and stays too.
/// Before `footprints.sort()`.
void leave_out_repeated(ProjectedFootprints& footprints, Diagnostics& diagnostics);

}  // namespace priormap
