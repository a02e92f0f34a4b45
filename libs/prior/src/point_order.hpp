#pragma once
#include <vector>

#include "point_record.hpp"

namespace priormap {

/// Sorts by position (x, y, z), then by the other columns, and keeps one point of each `same_point` group: the outcome depends
/// on the set of points alone. @param spare  memory to work in; holds nothing of use afterwards
void sort_and_unite(std::vector<PointRecord>& points, std::vector<PointRecord>& spare);
inline void sort_and_unite(std::vector<PointRecord>& points) {
  std::vector<PointRecord> spare;
  sort_and_unite(points, spare);
}

}  // namespace priormap
