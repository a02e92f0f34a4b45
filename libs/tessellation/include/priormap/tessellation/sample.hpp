#pragma once
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// Points on a mesh so that no spot of it is farther than about `spacing_m` from a point: the paper's tessellation with
/// 0.5 m edges (Kulmer et al. 2025, sec. III-A). Deterministic, depends on nothing but the mesh. Coplanar triangles of a planar mesh are sampled on one
/// regular grid in their plane; normals are the triangles'. Fills xyz (relative to `origin`) and normal.
PointCloud sample(const TriangleMesh& mesh, double spacing_m, const Eigen::Vector3d& origin);

}  // namespace priormap
