#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// Neighbouring points of one surface, reduced to what registration needs of them.
struct SurfacePatch {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();        ///< relative to the origin of the PatchCloud
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();      ///< unit; zero: no plane is known
  Eigen::Matrix<float, 6, 1> covariance = Eigen::Matrix<float, 6, 1>::Zero();   ///< of the points: xx, xy, xz, yy, yz, zz [m^2]
  float sigma_m = 0;                                     ///< root mean square of the points' own; unknown ones count as 0
  float count = 0;                                       ///< points
  std::uint32_t feature = PointCloud::no_feature;        ///< of all of them
};

struct PatchCloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<SurfacePatch> patches;

  std::size_t size() const { return patches.size(); }
  bool empty() const { return patches.empty(); }
};

/// One patch for each plane of a feature in a voxel (normals within 20 degrees, planes within 0.2 m of each other), one for the points without a normal. Voxels count from the
/// origin of the cloud. Positions in metres; points that are not finite are left out. In order of voxel, then of the first point: the same points in the same
/// order give the same bytes.
PatchCloud reduce_to_patches(const PointCloud& points, double voxel_m);

}  // namespace priormap
