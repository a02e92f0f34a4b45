#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <priormap/core/state_archive.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/pointcloud/surface_patches.hpp>
#include <priormap/registration/instruction_set.hpp>
#include <priormap/registration/surfel.hpp>
#include <priormap/registration/voxel_index.hpp>
#include <vector>

namespace priormap {

struct SurfelMapOptions {
  double voxel_m = 1.0;            ///< edge
  double plane_angle_rad = 0.35;   ///< points with normals join the surfel of their voxel whose normal is nearer than this,
  double plane_offset_m = 0.2;     ///< and whose plane is nearer than this
  double max_count = 1000;         ///< a surfel of so many points is left as it is
};

/// A target of JointRegistration: surfels in voxels, in blocks of 8 x 8 x 8 voxels with a dense index each, positions as structure of arrays relative to the block's
/// corner (float32 is exact to micrometres there, anywhere in a frame of 2^31 voxels).
/// Points with normals (a prior) make one surfel for each plane of a feature in a voxel; points without, and scans, one surfel a voxel from the moments of all that fell in.
/// What it holds depends on what was inserted and in which order, on nothing else. Const members may be called by several threads at once.
class SurfelMap {
 public:
  /// @throws UsageError unless voxel_m > 0.
  explicit SurfelMap(const SurfelMapOptions& options = {});
  ~SurfelMap();
  SurfelMap(SurfelMap&&) noexcept;
  SurfelMap& operator=(SurfelMap&&) noexcept;

  /// A prior's points, in the map's frame. Uses the columns normal and sigma_m where present. Points that are not finite are ignored.
  void insert(const PointCloud& points);
  /// A prior's points reduced already, in the map's frame.
  void insert(const PatchCloud& patches);
  /// A scan seen from `T_map_scan`, reduced to voxels of about this map's.
  void insert(const SurfelCloud& scan, const Eigen::Isometry3d& T_map_scan);
  /// Drops each block whose centre is farther than `distance_m` from `center`.
  void remove_beyond(const Eigen::Vector3d& center, double distance_m);

  /// Its surfels, for a map made with the same options.
  void exchange(StateArchive& archive);

  struct Match {
    Eigen::Vector3d mean;
    SurfelShape shape;
    double distance_m;         ///< to `mean`
    double second_distance_m;  ///< to the next nearest mean within the 27 voxels; infinity when there is none
  };
  /// The surfel with the nearest mean within the 27 voxels around `query`, all in the map's frame; none when they are empty. @throws UsageError for an instruction set that the processor lacks
  std::optional<Match> nearest(const Eigen::Vector3d& query, InstructionSet set = InstructionSet::best) const;

  std::size_t size() const { return size_; }  ///< surfels
  bool empty() const { return size_ == 0; }
  double voxel_m() const { return options_.voxel_m; }
  /// Means of all surfels, relative to `origin`, and their normals: unit of planes and lines, zero of others.
  PointCloud points(const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) const;

 private:
  friend class SurfelMapView;
  struct Item;
  class Block;

  Item place(const Eigen::Vector3d& p_map);
  void insert_items(const std::vector<Item>& items);

  SurfelMapOptions options_;
  VoxelIndex index_;            // block -> number
  std::vector<std::unique_ptr<Block>> blocks_;
  std::uint32_t last_block_ = 0;   // that something was placed in
  std::size_t size_ = 0;
};

}  // namespace priormap
