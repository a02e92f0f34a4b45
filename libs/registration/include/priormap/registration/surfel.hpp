#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace priormap {

/// A small patch of surface by the moments of the points on it, in the axes of its cloud.
struct Surfel {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();        ///< [m], relative to the origin of its cloud
  float count = 0;                                       ///< points behind the moments; above 0
  float time_s = 0;                                      ///< mean of the times of the points, from the scan's stamp; 0 where they have none
  Eigen::Matrix<float, 6, 1> covariance = Eigen::Matrix<float, 6, 1>::Zero();  ///< of the points, divided by their count: xx, xy, xz, yy, yz, zz [m^2]
};

/// What a surfel of the map says about a point of surface near it: with r the vector from `mean` to the point, its squared distance is
/// (isotropic |r|^2 + directed (normal . r)^2) / sigma^2.   plane: 0, 1.   line along `normal`: 1, -1.   scatter: 1, 0.   no use: 0, 0.
struct SurfelShape {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();   ///< unit, of either sign; zero for scatter and no use
  float isotropic = 0;
  float directed = 0;
  float sigma_m = 0;   ///< of the points about it
  bool tells_nothing() const { return isotropic == 0 && directed == 0; }
};

/// Moments of the union of the points of both.
void merge(Surfel& into, const Surfel& from);

/// Unit normal of the plane that the points of a surfel of a voxel lie in; zero when they make none.
Eigen::Vector3f normal_of(const Surfel& surfel, double voxel_m);

/// Surfels of one scan, in the frame of its sensor (x forward, y left, z up), relative to a double origin (as PointCloud).
struct SurfelCloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Surfel> surfels;
  /// Few surfels show by themselves what surface they lie on, as where a sensor of few lasers draws single traces. Says how the scan is to be registered, whatever is told of its surfels below.
  bool few_lasers = false;
  /// Of the surface that each lies on, by the points around it, where its own do not tell: of single traces there are several within some metres. As many, or empty: not told, for
  /// enough surfels tell for themselves, or because it went into the normals.
  std::vector<SurfelShape> around = {};
  /// Unit, of the surface that each lies on; zero where that is not known. As many, or empty: not asked for. With them ground is not compared with walls.
  std::vector<Eigen::Vector3f> normals = {};

  std::size_t size() const { return surfels.size(); }
  bool empty() const { return surfels.empty(); }
};

/// The surfels `which`, in this order, with all that is told of them. @param which  below scan.size()
SurfelCloud selected(const SurfelCloud& scan, std::span<const std::size_t> which);
/// Every `stride`-th surfel from the first one on, with all that is told of them. @param stride  1 at least
SurfelCloud every(const SurfelCloud& scan, std::size_t stride);

/// Normals of all surfels of a scan reduced to voxels of that edge: by their own points, else by those around them. `around`, which nothing asks for then, is given up with its memory.
void tell_normals(SurfelCloud& scan, double voxel_m);

}  // namespace priormap
