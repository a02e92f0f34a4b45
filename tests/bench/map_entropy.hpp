#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include <priormap/registration/voxel_index.hpp>

namespace priormap {

/// How crisp a map is around a point of it, by the covariance of the points within a radius (Droeschel and Behnke, ICRA 2014; Razlaw et al., ECMR 2015).
struct LocalSpread {
  double entropy;             ///< 1/2 ln |2 pi e covariance|, lengths in metres
  double plane_variance_m2;   ///< least eigenvalue of the covariance
};

/// Points of a map, ordered by voxels as wide as the radius.
class SpreadMap {
 public:
  SpreadMap(const std::vector<Eigen::Vector3d>& points_m, double radius_m);
  /// Nothing where fewer than `least` points lie within the radius, or all in one plane.
  std::optional<LocalSpread> around(const Eigen::Vector3d& query_m, int least) const;

 private:
  Eigen::Vector3i key_of(const Eigen::Vector3d& p) const { return (p / radius_m_).array().floor().cast<int>(); }

  double radius_m_;
  VoxelIndex index_;
  std::vector<std::size_t> ends_;         // of the points of each voxel
  std::vector<Eigen::Vector3d> points_;   // voxel by voxel
};

}  // namespace priormap
