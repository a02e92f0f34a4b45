#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <priormap/core/state_archive.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/registration/voxel_index.hpp>
#include <vector>

namespace priormap {

struct VoxelHashMapOptions {
  double voxel_m = 1.0;
  int max_points = 10;             ///< in one voxel
  double min_distance_m = 0.1;     ///< between points of one voxel

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("voxel", voxel_m, {"edge of a voxel of the target maps", "m", 0.05, 100});
    visit("max-points", max_points, {"most points kept in one voxel", "", 1, 1000});
    visit("min-distance", min_distance_m, {"least distance of points within a voxel", "m", 0, 100});
  }
};

/// A point of the map and how far it is from the query, in the map's frame.
struct Neighbor {
  Eigen::Vector3d position;
  double distance_m;
};

/// Points in hashed voxels: the linear iVox (Bai et al., Faster-LIO, RA-L 2022) of the paper. A voxel takes a point only while it is not full and no
/// point of that voxel is nearer than the least distance, so what it holds depends on the order of insertion and on nothing else.
/// Positions are kept as float32 relative to the voxel's corner: sub-micrometre anywhere in a frame of 2^31 voxels. Const members may be called by several threads at once.
class VoxelHashMap {
 public:
  /// @throws UsageError unless voxel_m > 0, max_points >= 1 and min_distance_m >= 0
  explicit VoxelHashMap(const VoxelHashMapOptions& options = {});

  /// Inserts points given in the map's frame after `T_map_points`. Points that are not finite are ignored.
  void insert(const PointCloud& points, const Eigen::Isometry3d& T_map_points = Eigen::Isometry3d::Identity());
  void insert(const Eigen::Vector3d& p_map);
  /// Drops each voxel whose centre is farther than `distance_m` from `center`.
  void remove_beyond(const Eigen::Vector3d& center, double distance_m);
  /// The nearest point within the 27 voxels around `query`; none when they are empty.
  std::optional<Neighbor> nearest(const Eigen::Vector3d& query) const;

  /// Its points, for a map made with the same options.
  void exchange(StateArchive& archive) { archive(index_, counts_, in_voxel_, size_); }

  std::size_t size() const { return size_; }  ///< points held
  bool empty() const { return size_ == 0; }
  std::size_t voxel_count() const { return index_.size(); }
  /// All points, relative to `origin`, voxel by voxel.
  PointCloud points(const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) const;
  const VoxelHashMapOptions& options() const { return options_; }

 private:
  Eigen::Vector3i key_of(const Eigen::Vector3d& p) const;
  Eigen::Vector3d corner_of(const Eigen::Vector3i& key) const { return key.cast<double>() * options_.voxel_m; }

  VoxelHashMapOptions options_;
  VoxelIndex index_;
  std::vector<std::uint32_t> counts_;      ///< points of each voxel
  std::vector<Eigen::Vector3f> in_voxel_;  ///< max_points per voxel, relative to the voxel's corner
  std::size_t size_ = 0;
};

}  // namespace priormap
