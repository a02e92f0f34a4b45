#pragma once
#include <cstddef>
#include <vector>

#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// RTE as the KITTI odometry benchmark measures it (Geiger et al., CVPR 2012): segments of eight lengths, one of each starting at every
/// 10th pose and ending at the first pose farther than that length along the reference; |t| / length and angle / length of
/// (reference motion)^-1 (estimated motion), averaged over all segments.
///
/// The lengths are 100, 200, ... 800 m. Where the reference is too short for a single one they are divided by ten (10 ... 80 m), and again by
/// ten (1 ... 8 m); `lengths_m` says which were met.
struct SegmentError {
  std::size_t segments = 0;
  std::vector<double> lengths_m;          ///< of which there is at least one segment
  double translation_ratio = 0;           ///< mean of |t| / length
  double rotation_rad_per_m = 0;          ///< mean of angle / length
};

/// Trajectories of equal length.
SegmentError segment_error(const Trajectory& reference, const Trajectory& estimate);

}  // namespace priormap
