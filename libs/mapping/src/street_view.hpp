#pragma once
#include <Eigen/Core>

namespace priormap {

/// What of a prior a scan from the street is to be compared with. Roofs are not: their heights and shapes in a prior are often guessed, and all to one side.

/// Whether a level or sloping surface there is no ground but a roof: it lies above the sensor, by more than streets climb. @param v  from the sensor, z up
inline bool is_above_street(const Eigen::Vector3d& v) {
  constexpr double steepest_street = 0.2;
  return v.z() > steepest_street * v.head<2>().norm();
}

}  // namespace priormap
