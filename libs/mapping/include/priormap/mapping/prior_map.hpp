#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <set>

#include <priormap/geodesy/map_frame.hpp>
#include <priormap/mapping/prior_points.hpp>
#include <priormap/registration/voxel_hash_map.hpp>

namespace priormap {

/// The prior around the vehicle, in the frame `map`: tiles are loaded as it comes near and dropped behind it.
class PriorMap {
 public:
  /// Tiles that come within `radius_m` of the pose are held. `points` must outlive this.
  PriorMap(const PriorPoints& points, const MapFrame& frame, const VoxelHashMapOptions& voxels, double radius_m);

  /// Loads and drops, then returns what is there.
  const VoxelHashMap& around(const Eigen::Vector3d& p_map);
  std::size_t tiles_held() const { return held_.size(); }

 private:
  Bounds2 bounds_around(const Eigen::Vector3d& p_map, double radius_m) const;

  const PriorPoints& points_;
  MapFrame frame_;
  double radius_m_;
  std::set<TileKey> held_;
  VoxelHashMap voxels_;
};

/// Points of one tile brought from the prior's CRS into `map`.
PointCloud tile_in_map(const PriorPoints& points, TileKey key, const MapFrame& frame);

/// Distance in metres from a place (in the prior's CRS) to the nearest tile; 0 inside one.
double distance_to_prior_m(const PriorPoints& points, const Eigen::Vector3d& projected);

}  // namespace priormap
