#pragma once
#include <span>

#include "merge/common_crs.hpp"

namespace priormap {

/// Warns of the first prior that cannot be reached from the first one in steps from prior to prior of at most 50 km: most likely it is of another place.
void warn_of_distant_priors(std::span<const PriorStore> priors, const CommonCrs& crs, const Events& events);

}  // namespace priormap
