#pragma once
#include <vector>

#include "point_record.hpp"

namespace priormap {

/// Sorts by position (x, y, z), then by the other columns, and keeps one point of each `same_point` group: the outcome depends
/// on the set of points alone.
void sort_and_unite(std::vector<PointRecord>& points);

}  // namespace priormap
