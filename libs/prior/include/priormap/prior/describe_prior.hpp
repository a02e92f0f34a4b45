#pragma once
#include <string>
#include <vector>

#include <priormap/prior/prior_store.hpp>

namespace priormap {

/// What is in a prior, for people: CRS, extent, points, and of each source who made it and how it came into the CRS.
std::string describe_prior(const PriorStore& prior);

/// The manifest as one JSON object; with `faults` also those that check_prior found.
std::string describe_prior_json(const PriorStore& prior, const std::vector<std::string>* faults = nullptr);

}  // namespace priormap
