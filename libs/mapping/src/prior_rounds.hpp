#pragma once
#include <functional>
#include <optional>
#include <vector>

#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/prior_window.hpp>
#include <priormap/mapping/mapper.hpp>

#include "drive_graph.hpp"
#include "prior_comparison.hpp"
#include "prior_pieces.hpp"
#include "scans_again.hpp"

namespace priormap {

/// Brings the graph of a drive and the prior together, round by round (docs/adr/0014): the keyframes that are located are compared with the prior at their poses, and what that says moves the
/// poses, the pieces of the prior, or both. First `vote`, then `estimate` from pass 0 on; stretches may be moved before any vote, which then begins with nothing known of the pieces.
class PriorRounds {
 public:
  /// All that is given must outlive this.
  PriorRounds(DriveGraph& graph, const NearTiles& prior, const ReadScan& read_again, const JointMethodOptions& options);

  /// Moves each stretch whose scans, all together, fit clearly better elsewhere (docs/adr/0023). @return whether there was one
  bool move_stretches();
  /// Finds anew where the walls of each piece lie, by votes (docs/adr/0017).
  void vote();
  /// Compares, and estimates the poses with the offsets of the pieces; unless it is the last pass, then the sigmas of the offsets as well. @param pass  from 0   @return how far the poses moved, level, on average [m]
  double estimate(int pass);

  /// Of the poses last estimated, with what they have in common.
  /// @param known_height_m  see `estimate_drive`
  std::vector<Matrix6d> covariances(std::optional<double> known_height_m) const;
  /// The poses around which the prior is of another place.
  std::vector<bool> contradicted() const { return pieces_.contradicted(graph_.size()); }

 private:
  /// Calls `take(k, matches)` for each located pose, in order.
  void compare(PriorComparison& comparison, const std::function<void(PoseId, const std::vector<PlaneMatch>&)>& take);

  DriveGraph& graph_;
  const NearTiles& prior_;
  const JointMethodOptions& options_;
  PiecesOfPrior unknown_, pieces_;
  PieceSigmas stated_, sigmas_;
  ScansAgain scans_;
  std::vector<Matrix6d> covariances_;
};

}  // namespace priormap
