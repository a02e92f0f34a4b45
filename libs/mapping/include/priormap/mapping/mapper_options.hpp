#pragma once
#include <string>
#include <variant>
#include <vector>

#include <priormap/posegraph/pose_graph.hpp>
#include <priormap/registration/register_joint.hpp>
#include <priormap/registration/register_scan.hpp>
#include <priormap/registration/surfel_map.hpp>
#include <priormap/registration/voxel_hash_map.hpp>

namespace priormap {

/// The published method: point to point, to the local map and to the prior one after the other, joined in a pose graph scan by scan.
struct PaperOptions {
  double downsample_m = 1.5;
  VoxelHashMapOptions voxels;
  IcpOptions icp;
  PoseGraphOptions graph;
  double min_motion_m = 0.1;
  double min_turn_deg = 1;   // the paper names no angle; without one a vehicle that turns on the spot is lost
  double min_inlier_share = 0.5;
  double local_map_radius_m = 100;

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
  }
};

/// Scan to local map.
struct OdometryOptions {
  JointOptions registration{.kernel_width = 2, .start_scale = 4, .max_iterations = 50};
  SurfelMapOptions local_map;
  double local_sigma_m = 0.02;
  double min_share = 0.03;
  double min_inlier_share = 0.5;
  PoseSearchOptions search;
  double local_map_radius_m = 100;

  template <class Visitor>
  void describe(Visitor& visit) {
    registration.describe(visit);
    visit("local-map-voxel", local_map.voxel_m, {"edge of the voxels of the local map", "m", 0.05, 10});
    visit("local-sigma", local_sigma_m, {"standard deviation added to that of a plane of the local map", "m", 0, 10});
    visit("min-inlier-share", min_inlier_share, {"share of the correspondences that must be inliers for a match to count", "", 0, 1});
    visit("min-local-share", min_share, {"share of a scan that the local map must know", "", 0, 1});
    visit("local-map-radius", local_map_radius_m, {"the local map is dropped beyond", "m", 1, 10000});
  }
};

/// Where the odometry lies in the prior, online.
struct TrackingOptions {
  JointOptions registration{.kernel_width = 2, .start_scale = 1, .hears_weakest_direction = false};
  SurfelMapOptions prior;
  PoseSearchOptions search;
  int start_keyframes = 12;
  double search_step_m = 5;
  double keyframe_m = 20;
  double prior_sigma_m = 0.1;
  double prior_floor_m = 0.3;
  double drift_m = 0.02;
  double drift_rad = 5e-4;
  double min_share = 0.1;
  double min_inlier_share = 0.5;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("prior-voxel", prior.voxel_m, {"edge of the voxels of the prior", "m", 0.05, 10});
    visit("keyframe", keyframe_m, {"way between scans that are matched to the prior where it holds the drive", "m", 0, 100});
    visit("search-step", search_step_m, {"the same at the start and where the prior does not hold it", "m", 0.1, 100});
    visit("start-keyframes", start_keyframes, {"keyframes by which other places near the given start are compared with it; 0: it is trusted", "", 0, 1000});
    visit("start-radius", search.radius_m, {"distance from the given start up to which it may lie", "m", 0, 100});
    visit("start-angle", search.yaw_rad, {"angle from the given direction up to which it may be turned", "rad", 0, 3.2});
    visit("prior-sigma", prior_sigma_m, {"standard deviation added to that of a plane of the prior", "m", 0, 10});
    visit("prior-floor", prior_floor_m, {"no match to the prior is surer than this, for its errors hang together", "m", 0, 10});
    visit("drift", drift_m, {"drift of the odometry over the way of a search step, standard deviation", "m", 1e-4, 10});
    visit("drift-angle", drift_rad, {"the same of its direction", "rad", 1e-6, 1});
    visit("min-prior-share", min_share, {"share of a scan that the prior must know to be heard", "", 0, 1});
    visit("min-prior-inlier-share", min_inlier_share, {"share of that part that must fit", "", 0, 1});
  }
};

/// The estimate of the whole drive.
struct EstimateOptions {
  double keyframe_m = 10;
  double motion_scale = 1;
  double range_m = 70;
  double piece_m = 20;
  double building_sigma_m = 0.3;
  double wall_sigma_m = 0.3;
  double roof_overhang_m = 0.2;
  double slope_sigma_m = 0.3;
  double turn_sigma_rad = 0.02;
  double ground_sigma_m = 0.1;
  double surface_sigma_m = 0.1;
  double ground_surface_sigma_m = 0.03;
  double common_share = 0.06;
  double wall_common_share = 0.06;
  double ground_common_share = 0.01;
  double tilt_scale = 0.45;
  double kernel_width = 3;
  double ground_kernel_width = 2.5;
  int passes = 3;
  PoseGraphOptions graph{.absolute_width = 0, .between_width = 0};

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("estimate-keyframe", keyframe_m, {"way between the poses that are estimated; scans in between ride along", "m", 0, 100});
    visit("motion-scale", motion_scale, {"how much less sure the relative poses are than their matching says", "", 0.01, 100});
    visit("piece-range", range_m, {"the prior is compared up to this far from the sensor", "m", 1, 1000});
    visit("piece", piece_m, {"edge of the cells in which the errors of the prior are taken to be one", "m", 1, 1000});
    visit("building-sigma", building_sigma_m, {"standard deviation of the offsets of the prior's buildings to begin with, unless the prior states more; it is estimated", "m", 1e-3, 100});
    visit("wall-sigma", wall_sigma_m, {"the same of walls that belong to no building known", "m", 1e-3, 100});
    visit("roof-overhang", roof_overhang_m, {"by which the walls of a surface model are expected to stand outside of the real ones, for it sees roofs; it is estimated", "m", 0, 10});
    visit("turn-sigma", turn_sigma_rad, {"sigma of the angle by which a building or another piece is turned upright", "rad", 0, 1});
    visit("slope-sigma", slope_sigma_m, {"the same of slopes, such as the edges of a surface model", "m", 1e-3, 100});
    visit("ground-sigma", ground_sigma_m, {"the same of level ground", "m", 1e-3, 100});
    visit("common-share", common_share, {"share of the variance of the buildings' offsets that those within sight of one place have in common, which their number does not average out", "", 0, 1});
    visit("wall-common-share", wall_common_share, {"the same of walls that belong to no building known, which a surface model puts to one side of the real ones", "", 0, 1});
    visit("ground-common-share", ground_common_share, {"the same of the ground", "", 0, 1});
    visit("tilt-scale", tilt_scale, {"standard deviation of roll and pitch, as a share of what they would have if pieces of ground erred independently: neighbours err alike", "", 0.01, 1});
    visit("surface-sigma", surface_sigma_m, {"roughness of the prior's surfaces against the real ones, within a piece", "m", 1e-3, 10});
    visit("ground-surface-sigma", ground_surface_sigma_m, {"the same of its ground", "m", 1e-3, 10});
    visit("piece-kernel-width", kernel_width, {"width of the Geman-McClure kernel within a piece, in standard deviations", "", 0.5, 100});
    visit("ground-kernel-width", ground_kernel_width, {"the same on level ground", "", 0.5, 100});
    visit("passes", passes, {"times that the drive is compared with the prior and estimated anew, after a first look at where its walls lie", "", 1, 10});
    graph.describe(visit);
  }
};

/// Surfels to planes of the local map and of the prior, and one estimate of the whole drive.
struct JointMethodOptions {
  double reduce_m = 1.0;
  OdometryOptions odometry;
  TrackingOptions tracking;
  EstimateOptions estimate;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("reduce", reduce_m, {"edge of the voxels to whose moments a scan is reduced", "m", 0.05, 10});
    odometry.describe(visit);
    tracking.describe(visit);
    estimate.describe(visit);
  }
};

/// How a drive is cut into stretches that are driven at once.
struct StretchOptions {
  int scans = 250;
  int overlap = 40;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("stretch", scans, {"with --jobs above 1: scans of a stretch, or some more", "", 20, 1e6});
    visit("stretch-overlap", overlap, {"with --jobs above 1: scans that a stretch begins early, to come to know the street; by them it is joined to the one before", "", 10, 1e4});
  }
};

/// The parameters of the method. One set serves every sensor and place; `paper()` is the published one (VEHITS 2025).
struct MapperOptions {
  std::variant<JointMethodOptions, PaperOptions> method;
  double prior_radius_m = 150;   ///< the prior is held within: a scan's range and some

  static MapperOptions paper() { return {PaperOptions{}}; }
  /// @throws UsageError for an unknown name
  static MapperOptions preset(const std::string& name);

  template <class Visitor>
  void describe(Visitor& visit) {
    std::visit([&](auto& options) { options.describe(visit); }, method);
    visit("prior-radius", prior_radius_m, {"the prior is held within while the drive is followed; the estimate of the whole drive holds it within piece-range and 45 m", "m", 1, 10000});
  }
};

std::vector<std::string> preset_names();

}  // namespace priormap
