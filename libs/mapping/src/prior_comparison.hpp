#pragma once
#include <Eigen/Geometry>
#include <vector>

#include <priormap/core/reused.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/prior_window.hpp>
#include <priormap/registration/register_joint.hpp>

#include "prior_pieces.hpp"
#include "prior_surfels.hpp"

namespace priormap {

/// Compares scans with the prior where they are thought to have been taken, its buildings moved to where they were found.
class PriorComparison {
 public:
  /// Scans from places this far apart are compared with what is loaded once.
  static constexpr double together_m = 40;

  /// @param pieces  must outlive this; buildings are where it has them when their tiles are loaded
  PriorComparison(const NearTiles& prior, const PiecesOfPrior& pieces, const JointMethodOptions& options);

  void move_to(const Eigen::Vector3d& p_map) { window_.around(p_map); }
  /// Of a scan within `together_m` of there; by several threads at once.
  std::vector<PlaneMatch> at(const SurfelCloud& surfels, const Eigen::Isometry3d& T_map_sensor);
  /// By how much a scan within `together_m` of there fits the walls that belong to no feature better at each of the shifts (ShiftScores); by several threads at once. Outlines err each in its own
  /// way, and have their votes.
  std::vector<double> improvements(const SurfelCloud& surfels, const Eigen::Isometry3d& T_map_sensor);
  /// Root mean square of what the buildings loaded so far state; 0 where they state nothing.
  double stated_building_sigma_m() const { return window_.map().stated_sigma_m(PriorSurfels::of_features); }

 private:
  PriorWindow<PriorSurfels> window_;
  Reused<JointRegistration> registrations_;
};

}  // namespace priormap
