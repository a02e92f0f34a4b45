#pragma once
#include <span>
#include <string>
#include <vector>

#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

/// The sources of all priors, each once. Two are the same when id and sha256 agree.
struct MergedSources {
  std::vector<PriorSource> sources;                       ///< `precedence` counts up from 0; equal: never thinned against each other
  std::vector<std::vector<std::uint16_t>> index_of_input; ///< [input][its source] -> position in `sources`
};

/// @param precedence  kinds or ids, the highest first; sources not named follow in the order of the priors, and within a prior in the
/// order in which it was merged itself.
/// @throws UsageError for a name that no source has
MergedSources merge_sources(std::span<const PriorManifest> priors, std::span<const std::string> precedence);

}  // namespace priormap
