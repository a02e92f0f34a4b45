#include <priormap/evaluation/statistics.hpp>

#include <algorithm>
#include <cmath>

namespace priormap {

Statistics statistics(std::vector<double> values) {
  Statistics result{.count = values.size()};
  if (values.empty()) return result;
  double sum = 0, sum_of_squares = 0;
  for (double& value : values) {
    value = std::abs(value);
    sum += value;
    sum_of_squares += value * value;
  }
  const auto count = static_cast<double>(values.size());
  result.mean = sum / count;
  result.rmse = std::sqrt(sum_of_squares / count);
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  result.median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  result.max = values.back();
  return result;
}

}  // namespace priormap
