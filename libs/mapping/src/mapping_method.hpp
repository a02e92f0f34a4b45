#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <priormap/core/se3.hpp>
#include <priormap/core/state_archive.hpp>
#include <priormap/mapping/mapped_scan.hpp>
#include <priormap/mapping/mapper.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/prior_window.hpp>
#include <priormap/mapping/scan.hpp>

namespace priormap {

/// A pose and how sure it is; tangent [rotation, translation] in sensor axes.
struct EstimatedPose {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();
  Vector6d velocity = Vector6d::Zero();   ///< rad/s, m/s in sensor axes
  bool contradicted = false;              ///< by the walls of the prior
  bool calibrated = false;                ///< whether the covariance holds against true errors
};

/// Scans [first, last) of a source, to be placed in stretches, `jobs` at once.
struct Stretches {
  const ScanSource& source;
  std::size_t first, last;
  StretchOptions options;
  int jobs;
};

/// What is known of a scan before it is placed.
MappedScan facts_of(const Scan& scan);

/// One way to map a recording: the published one, or the joint one.
class MappingMethod {
 public:
  virtual ~MappingMethod() = default;
  /// As Mapper::preparation.
  virtual PrepareScan preparation() const = 0;
  /// Places a scan when it comes. @return its facts with the online pose, the verdict and the figures
  virtual MappedScan place(ReadyScan scan) = 0;
  /// Places those of the scans that are not placed yet, and tells after each stretch. @throws UsageError where each scan needs the one before
  virtual void place_stretches(const Stretches& stretches, const std::function<void(std::vector<MappedScan>)>& placed);
  /// The poses of all scans from everything that is known at the end.
  virtual std::vector<EstimatedPose> finish(const ReadScan& read_again) = 0;
  /// All that the scans so far have left, for a method made with the same options, prior and start.
  virtual void exchange(StateArchive& archive) = 0;
};

std::unique_ptr<MappingMethod> make_paper_method(const PaperOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first, int threads);
std::unique_ptr<MappingMethod> make_joint_method(const JointMethodOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first);

/// Fewer of a scan's points with a neighbour in the prior than this share, and there is no prior to speak of.
constexpr double outside_share = 0.05;
/// Below this share the prior holds the pose by a corner of the scan only.
constexpr double weak_share = 0.3;

}  // namespace priormap
