#pragma once
#include <vector>

#include <priormap/evaluation/trajectory.hpp>
#include <priormap/geodesy/geo_point.hpp>

namespace priormap {

/// What KITTI's OXTS unit gives: WGS 84 with ellipsoidal height, R = Rz(yaw) Ry(pitch) Rx(roll), yaw from true east.
struct OxtsPose {
  GeoPoint position;
  double roll_rad = 0, pitch_rad = 0, yaw_rad = 0;
};

/// Adds the poses in the UTM zone of the first one (heights as they are) and sets the trajectory's CRS.
void to_utm(const std::vector<OxtsPose>& oxts, Trajectory& trajectory);

}  // namespace priormap
