#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/prior_window.hpp>
#include <priormap/mapping/scan_source.hpp>

#include "mapping_method.hpp"
#include "odometry.hpp"

namespace priormap {

/// What the online pass says of one scan: all that the estimate of the whole drive needs.
struct ScanRecord {
  std::size_t index;              ///< in the recording
  double stamp_s;
  OdometryStep odometry;
  Eigen::Isometry3d T_map_online;
  bool located = true;            ///< T_map_online is known; not so beyond a gap in the odometry until the drive is found again
};

/// The best poses of a whole drive: one sparse graph over keyframes and pieces of the prior, in a few passes: compare the keyframes with the prior at their
/// poses, estimate, and again.
///
/// A match to the local map errs about as much as its information says, but the next one errs about the same map, not about the last pose: the errors do not add up
/// scan by scan. What adds up is the drift of the map itself, by the way driven. So keyframes stand some metres apart, between two of them counts one match, and the
/// scans in between ride along.
/// @param known_height_m  of the first scan, from elsewhere than the prior: what the prior is biased by as a whole no scan can tell, so that heights are no surer than these two agree
std::vector<EstimatedPose> estimate_drive(std::vector<ScanRecord> records, const std::optional<NearTiles>& prior, const ReadScan& read_again,
                                          const JointMethodOptions& options, std::optional<double> known_height_m = std::nullopt);

}  // namespace priormap
