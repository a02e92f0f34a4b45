#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <priormap/core/events.hpp>

namespace priormap {

/// Everything that is wrong with a prior, one line each: schema, CRS, index (digests, order, sums), features, and each tile: file,
/// digest, points inside their tile, heights, numbers of sources and features, CRS. Empty: the prior is whole.
std::vector<std::string> check_prior(const std::filesystem::path& directory, int threads, const Events& events = {});

}  // namespace priormap
