#pragma once
#include <cmath>

#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// Raises each point's elevation angle by `angle_rad`, keeping range and azimuth: a rotation about the horizontal axis that is
/// perpendicular to the ray, in closed form (no rotation matrix a point). A point on the vertical axis stays.
inline void raise_vertical_angles(PointCloud& cloud, double angle_rad) {
  const float c = static_cast<float>(std::cos(angle_rad)), s = static_cast<float>(std::sin(angle_rad));
  for (auto& p : cloud.xyz) {
    const float horizontal = std::hypot(p.x(), p.y());
    if (horizontal == 0) continue;
    const float scale = c - s * p.z() / horizontal;
    p = {p.x() * scale, p.y() * scale, c * p.z() + s * horizontal};
  }
}

}  // namespace priormap
