#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "drive_graph.hpp"
#include "prior_comparison.hpp"
#include "scans_again.hpp"

namespace priormap {

/// Where the scans of a stretch of poses, all together, fit the prior clearly better (ShiftScores): by how much they are to be moved, level, in map axes [m]. None where they do not,
/// or where they are too few to tell.
std::optional<Eigen::Vector2d> common_shift(const DriveGraph& graph, const std::vector<PoseId>& stretch, PriorComparison& comparison, ScansAgain& scans, int threads);

}  // namespace priormap
