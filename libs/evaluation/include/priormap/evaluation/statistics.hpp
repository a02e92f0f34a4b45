#pragma once
#include <cstddef>
#include <vector>

namespace priormap {

/// Of absolute values; all zero where `count` is zero. The median of an even count is the mean of the two in the middle.
struct Statistics {
  std::size_t count = 0;
  double mean = 0, rmse = 0, median = 0, max = 0;
};

Statistics statistics(std::vector<double> values);

}  // namespace priormap
