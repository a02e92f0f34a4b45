#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <priormap/core/state_archive.hpp>
#include <priormap/mapping/mapped_scan.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/prior_window.hpp>
#include <priormap/mapping/scan_source.hpp>
#include <priormap/registration/surfel.hpp>

namespace priormap {

/// Where the first scan was taken, roughly, and how far the sensor moves from one scan to the next there.
struct FirstPose {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();   ///< T_previous_sensor,
  double motion_s = 0.1;                                      ///< in that time
  bool knows_height = false;                                   ///< from elsewhere than the prior, whose heights it can check
};

/// A scan made ready to be placed, as far as no pose is needed for it.
struct ReadyScan {
  MappedScan facts;             ///< all but where it was taken
  SurfelCloud surfels;          ///< for the default method
  PointCloud points, thinned;   ///< for the paper's
};

/// Keeps buffers from scan to scan: one a thread.
using PrepareScan = std::function<ReadyScan(const Scan&)>;

/// Reads a scan of the recording again, by its index; called by several threads at once.
using ReadScan = std::function<Scan(std::size_t)>;

/// Maps a sequence of scans against a prior, by one of two methods. The default: odometry by surfels, its keyframes compared with the prior, and at the end one estimate of the whole drive in which pieces of the prior may lie off.
/// The paper's (Kulmer et al., OpenLiDARMap, VEHITS 2025): each scan is matched to the prior (absolute pose) and to a local map of the scans before it (relative pose); a pose graph joins the two.
class Mapper {
 public:
  /// @param prior  the prior's tiles in the frame `map`; none: odometry
  Mapper(const MapperOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first, int threads);
  ~Mapper();
  Mapper(Mapper&&) noexcept;

  /// Makes scans ready for this mapper, by a thread of its own if wanted.
  PrepareScan preparation() const;
  /// Places one scan; scans come in the order of the recording. @return where it was taken, as far as is known when it comes; valid until the next one
  const MappedScan& step(ReadyScan scan);
  const MappedScan& step(const Scan& scan);

  /// Places the scans [first, last) of a source that it has not placed yet, `jobs` stretches at once: each is driven by an odometry of its own, and joined to the one before.
  /// The result differs from that of single steps by millimetres; it depends on `options`, not on `jobs`.
  /// @param placed  is told after each stretch how its scans went
  /// @throws UsageError for the paper's method
  void step_stretches(const ScanSource& source, std::size_t first, std::size_t last, const StretchOptions& options, int jobs, const std::function<void(std::span<const MappedScan>)>& placed);

  std::size_t num_scans() const;
  /// All that the scans so far have left, for a mapper made with the same options, prior and start.
  void exchange(StateArchive& archive);

  /// All scans with their final poses and covariances; one at least has been placed. @param read_again  for comparing scans with the prior anew at better poses; what it throws is passed on
  std::vector<MappedScan> finish(const ReadScan& read_again);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace priormap
