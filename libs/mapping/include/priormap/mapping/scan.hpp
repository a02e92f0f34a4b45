#pragma once
#include <cstddef>
#include <string>

#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// One sweep of the sensor: points in the sensor frame (x forward, y left, z up), as the sensor gave them but for points that are no
/// measurement (NaN, infinite, at the sensor itself, or beyond 10 km), which are left out and counted.
struct Scan {
  std::size_t index = 0;          ///< in its source
  double stamp_s = 0;
  PointCloud points;              ///< origin zero; `time_s` from the stamp where the sensor or the dataset knows it
  std::size_t num_skipped = 0;    ///< points left out
};

}  // namespace priormap
