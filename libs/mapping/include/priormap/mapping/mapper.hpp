#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include <priormap/mapping/mapped_scan.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/prior_map.hpp>
#include <priormap/mapping/scan.hpp>
#include <priormap/posegraph/pose_graph.hpp>
#include <priormap/registration/voxel_hash_map.hpp>

namespace priormap {

/// Maps a sequence of scans against a prior (Kulmer et al., OpenLiDARMap, VEHITS 2025): each scan is matched to the prior (absolute pose) and to a local
/// map of the scans before it (relative pose); a pose graph joins the two.
class Mapper {
 public:
  /// @param prior  none: odometry; must outlive this
  /// @param T_map_first  where the first scan was taken, roughly
  Mapper(const MapperOptions& options, PriorMap* prior, const Eigen::Isometry3d& T_map_first, int threads);

  /// Places one scan. The scan must hold points.
  const MappedScan& step(const Scan& scan);

  /// All scans so far, with covariances.
  std::vector<MappedScan> finish() const;

 private:
  bool stands_still(const RegistrationResult& to_local) const;
  void repeat_last(MappedScan& mapped);
  bool accepts(const RegistrationResult& match) const;
  void place(MappedScan& mapped, const Eigen::Isometry3d& guess, const std::optional<RegistrationResult>& to_local,
             const std::optional<RegistrationResult>& to_prior, std::size_t num_points);

  MapperOptions options_;
  PriorMap* prior_;
  int threads_;
  Eigen::Isometry3d T_map_last_, T_map_before_last_;
  VoxelHashMap local_map_;
  PoseGraph graph_;
  std::vector<MappedScan> scans_;
  std::vector<PoseId> pose_of_scan_;
};

}  // namespace priormap
