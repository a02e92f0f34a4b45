#pragma once
#include <optional>
#include <vector>

#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/prior_window.hpp>
#include <priormap/mapping/mapper.hpp>

#include "mapping_method.hpp"
#include "scan_record.hpp"

namespace priormap {

/// The best poses of a whole drive: one sparse graph over keyframes and pieces of the prior (DriveGraph), in a few passes: compare the keyframes with the prior at their
/// poses, estimate, and again (PriorRounds).
/// @param known_height_m  of the first scan, from elsewhere than the prior: what the prior is biased by as a whole no scan can tell, so that heights are no surer than these two agree
/// @return one for each record, in order
std::vector<EstimatedPose> estimate_drive(std::vector<ScanRecord> records, const std::optional<NearTiles>& prior, const ReadScan& read_again,
                                          const JointMethodOptions& options, std::optional<double> known_height_m = std::nullopt);

}  // namespace priormap
