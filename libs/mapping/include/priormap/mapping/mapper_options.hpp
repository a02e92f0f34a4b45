#pragma once
#include <string>
#include <vector>

#include <priormap/posegraph/pose_graph.hpp>
#include <priormap/registration/register_scan.hpp>
#include <priormap/registration/voxel_hash_map.hpp>

namespace priormap {

/// The parameters of the method. One set serves every sensor and place; `paper()` is the published one (VEHITS 2025).
struct MapperOptions {
  double downsample_m = 1.5;              ///< edge of the voxels to which a scan is thinned before matching
  VoxelHashMapOptions voxels;             ///< of prior and local map
  IcpOptions icp;                         ///< of both matchings
  PoseGraphOptions graph;
  double min_motion_m = 0.1;              ///< less since the last pose, and less turned than the next: the vehicle stands still
  double min_turn_deg = 1;                ///< the paper names no angle; without one a vehicle that turns on the spot is lost
  double min_inlier_share = 0.5;          ///< of the correspondences with the prior, for an absolute constraint
  double local_map_radius_m = 100;        ///< the local map is dropped beyond
  double prior_radius_m = 150;            ///< the prior is held within: a scan's range and some

  static MapperOptions paper() { return {}; }
  /// @throws UsageError for an unknown name
  static MapperOptions preset(const std::string& name);

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("downsample", downsample_m, {"edge of the voxels to which a scan is thinned before matching", "m", 0.05, 10});
    voxels.describe(visit);
    icp.describe(visit);
    graph.describe(visit);
    visit("min-motion", min_motion_m, {"less motion than this since the last pose: the vehicle stands still", "m", 0, 10});
    visit("min-turn", min_turn_deg, {"less turn than this and less motion since the last pose: the vehicle stands still", "deg", 0, 180});
    visit("min-inlier-share", min_inlier_share, {"share of the correspondences that must be inliers for a match to count", "", 0, 1});
    visit("local-map-radius", local_map_radius_m, {"the local map is dropped beyond", "m", 1, 10000});
    visit("prior-radius", prior_radius_m, {"the prior is held within", "m", 1, 10000});
  }
};

std::vector<std::string> preset_names();

}  // namespace priormap
