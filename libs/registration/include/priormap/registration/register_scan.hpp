#pragma once
#include <Eigen/Geometry>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/registration/registration_result.hpp>
#include <priormap/registration/voxel_hash_map.hpp>

namespace priormap {

/// Of `register_scan`; all above 0.
struct IcpOptions {
  double max_distance_m = 6.0;
  double kernel_width_m = 1.0;
  int max_iterations = 100;
  double translation_epsilon_m = 1e-3;
  double rotation_epsilon_rad = 1e-4;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("max-distance", max_distance_m, {"correspondences farther apart are dropped", "m", 0.01, 1000});
    visit("kernel-width", kernel_width_m, {"width of the Geman-McClure kernel; residuals below it count as inliers", "m", 1e-3, 1000});
    visit("max-iterations", max_iterations, {"most Gauss-Newton steps of one registration", "", 1, 10000});
    visit("translation-epsilon", translation_epsilon_m, {"a step shorter than this and turning less than rotation-epsilon ends it", "m", 1e-9, 1});
    visit("rotation-epsilon", rotation_epsilon_rad, {"see translation-epsilon", "rad", 1e-9, 1});
  }
};

/// Point-to-point ICP of `points` (sensor frame) against `target`, from `T_target_source`: nearest neighbours over 27 voxels, Geman-McClure kernel,
/// Gauss-Newton (the paper, section III-B). A residual r has weight (k^2 / (k^2 + r^2))^2.
/// A correspondence is a point with a neighbour within max_distance_m; an inlier one with a residual below kernel_width_m, both at the pose returned.
/// Not converged: fewer than 3 correspondences (the guess comes back), a system that cannot be solved, or max_iterations.
/// @param T_target_source  a guess, within some metres and degrees   @param threads  1 at least
/// The sums run over fixed chunks in order: the same bytes for any number of threads.
RegistrationResult register_scan(const PointCloud& points, const VoxelHashMap& target, const Eigen::Isometry3d& T_target_source,
                                 const IcpOptions& options, int threads = 1);

}  // namespace priormap
