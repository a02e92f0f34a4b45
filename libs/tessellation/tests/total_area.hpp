#pragma once
#include <vector>

#include <priormap/tessellation/polygon.hpp>

namespace priormap {

inline double total_area(const std::vector<Polygon2>& polygons) {
  double sum = 0;
  for (const Polygon2& polygon : polygons) sum += area(polygon);
  return sum;
}

}  // namespace priormap
