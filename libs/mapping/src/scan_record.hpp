#pragma once
#include <Eigen/Geometry>
#include <cstddef>

#include "odometry.hpp"

namespace priormap {

/// What the online pass says of one scan: all that the estimate of the whole drive needs.
struct ScanRecord {
  std::size_t index;              ///< in the recording
  double stamp_s;
  OdometryStep odometry;
  Eigen::Isometry3d T_map_online;
  bool located = true;            ///< T_map_online is known; not so beyond a gap in the odometry until the drive is found again
};

}  // namespace priormap
