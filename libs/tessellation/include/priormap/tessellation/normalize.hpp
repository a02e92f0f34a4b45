#pragma once
#include <string>
#include <vector>

#include <priormap/core/diagnostics.hpp>
#include <priormap/tessellation/polygon.hpp>

namespace priormap {

/// Polygons from rings of any order and direction [m], by the even-odd rule: what an odd number of rings encloses is inside. Rings may touch or share
/// edges (a shared edge vanishes). Drops repeated points and spikes. Crossing rings are split where they cross.
/// Defects are reported under `feature`: 101, 102, 104, 201, 705 of DiagnosticCode.
/// @return simple polygons, exterior counter-clockwise, holes clockwise, in a fixed order; empty when no area is left.
std::vector<Polygon2> normalize(const std::vector<Ring2>& rings, const std::string& feature, Diagnostics& diagnostics);
std::vector<Polygon2> normalize(const Polygon2& polygon, const std::string& feature, Diagnostics& diagnostics);

}  // namespace priormap
