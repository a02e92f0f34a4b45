#pragma once
#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// Gives points without a normal that of the plane of their neighbours without one: those within 0.5 m, or within 1, 2 or 4 m where so few lie nearer that they
/// make no surface. A point whose neighbourhood is no plane keeps none. Positions in metres.
/// Which side is outside cannot be known: normals point up, those of walls to one half of the horizon. The roughness of the neighbourhood is added (in squares)
/// to sigma_m; an unknown sigma counts as 0.
void estimate_normals(PointCloud& points);

}  // namespace priormap
