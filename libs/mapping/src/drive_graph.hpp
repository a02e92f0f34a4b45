#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include <priormap/core/se3.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/posegraph/pose_graph.hpp>

#include "mapping_method.hpp"
#include "prior_pieces.hpp"
#include "scan_record.hpp"

namespace priormap {

/// The graph of a drive: its keyframes, tied by the odometry, and the pieces of the prior that they see.
///
/// A match to the local map errs about as much as its information says, but the next one errs about the same map, not about the last pose: the errors do not add up
/// scan by scan. What adds up is the drift of the map itself, by the way driven. So keyframes stand some metres apart, between two of them counts one match, and the
/// scans in between ride along. Poses are T_map_sensor of keyframes, numbered from 0 in the order of the drive; covariances are in the tangent [rotation, translation] of sensor axes.
class DriveGraph {
 public:
  /// Poses as the online pass left them. @param records  of all scans, one at least; they and the options must outlive this
  DriveGraph(const std::vector<ScanRecord>& records, const EstimateOptions& options);
  std::size_t size() const { return keyframes_.size(); }
  const ScanRecord& record(PoseId k) const { return records_[keyframes_[k].record]; }
  const Eigen::Isometry3d& pose(PoseId k) const { return poses_[k]; }
  const std::vector<Eigen::Isometry3d>& poses() const { return poses_; }
  bool is_located(PoseId k) const { return record(k).located; }

  /// The poses that are located, in order, in groups that lie within `distance_m` of their first one.
  std::vector<std::vector<PoseId>> located_within(double distance_m) const;
  /// Poses that are located, in order, some hundred metres of way without a gap in the odometry.
  std::vector<std::vector<PoseId>> stretches() const;
  /// Moves poses level, in map axes.
  void shift(const std::vector<PoseId>& keys, const Eigen::Vector2d& shift_m);

  /// New poses by the odometry alone, from where the drive starts. @return their covariances from there
  std::vector<Matrix6d> estimate();
  struct Estimate {
    Marginals marginals;           ///< at the new poses
    std::vector<double> weights;   ///< of the pieces' offsets under their kernel
  };
  /// New poses by what the pieces of the prior say, whose offsets are taken; the start is a guess in the frame of the prior.
  /// @param least_gain  see PoseGraph::optimize
  Estimate estimate(PiecesOfPrior& pieces, const PieceSigmas& sigmas, double least_gain);

  /// Adds what poses have in common: `common` is of one place, and places that have no piece of the prior in sight in common are averaged where the odometry ties them.
  /// @param held  poses that the prior holds
  void add_common(const CommonVariance& common, const std::vector<bool>& held, std::vector<Matrix6d>& covariances) const;
  /// Multiplies the standard deviations of roll and pitch of the poses that the prior holds; what they have to do with the others goes with them.
  void scale_tilts(double scale, const std::vector<bool>& held, std::vector<Matrix6d>& covariances) const;
  /// Where the prior puts the start clearly above or below its known height, one of both is wrong, and no scan tells which.
  void doubt_heights(double known_height_m, std::vector<Matrix6d>& covariances) const;

  /// All scans: those between keyframes ride along, corrected little by little; those followed apart before the odometry began anew with the keyframe where it did.
  std::vector<EstimatedPose> all_poses(const std::vector<Matrix6d>& covariances, const std::vector<bool>& contradicted) const;

 private:
  struct Keyframe {
    std::size_t record;
    Matrix6d motion_covariance;   ///< from the keyframe before, tangent at this one
  };
  static std::vector<Keyframe> keyframes_of(const std::vector<ScanRecord>& records, const EstimateOptions& options);
  PoseGraph tied_by_odometry() const;
  void optimize(PoseGraph& graph, double least_gain);
  /// How many of the held poses [begin, end) are out of each other's sight; one at least. What a whole source has in common no drive averages out, hence the bound.
  std::size_t places_apart(PoseId begin, PoseId end, const std::vector<bool>& held) const;
  const Eigen::Isometry3d& T_odom(PoseId k) const { return record(k).odometry.T_odom_sensor; }

  const std::vector<ScanRecord>& records_;
  const EstimateOptions& options_;
  std::vector<Keyframe> keyframes_;
  std::vector<Eigen::Isometry3d> poses_;
  Eigen::Isometry3d T_map_start_;
};

}  // namespace priormap
