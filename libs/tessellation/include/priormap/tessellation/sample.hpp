#pragma once
#include <memory>
#include <vector>

#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// Points on planar faces so that no spot of a face is farther than `spacing_m` from a point: the paper's tessellation with 0.5 m edges
/// (Kulmer et al. 2025, sec. III-A). Each face carries a regular grid of its own, aligned with its longest edge and spread evenly over its extent, and points
/// along all its edges: the result depends on nothing but the face. Even-odd rule, so holes and self-touching rings need no triangulation.
/// Keeps scratch memory between calls: one object per thread.
class FaceSampler {
 public:
  explicit FaceSampler(double spacing_m);
  ~FaceSampler();

  /// Appends the points of a face. @return its unit normal; zero for a face without area, which gets no points.
  Eigen::Vector3d sample(const Polygon3& face, std::vector<Eigen::Vector3d>& points);
  /// Appends the points of a mesh and their normals. Connected triangles in one plane (1 mm) are one face; they must share vertices to be seen as connected.
  void sample(const TriangleMesh& mesh, std::vector<Eigen::Vector3d>& points, std::vector<Eigen::Vector3d>& normals);

 private:
  struct Scratch;
  double spacing_m_;
  std::unique_ptr<Scratch> scratch_;
};

/// The points of a mesh as a cloud: xyz (relative to `origin`) and normal.
PointCloud sample(const TriangleMesh& mesh, double spacing_m, const Eigen::Vector3d& origin);

}  // namespace priormap
