#include "nearest_name.hpp"

#include <algorithm>

namespace priormap::cli {
namespace {

/// Optimal string alignment distance (Damerau 1964, each letter touched once).
std::size_t slips_between(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(const std::string& written, const std::vector<std::string>& names) {
  if (written.empty()) return std::nullopt;
  std::optional<std::string> nearest, longer;
  std::size_t fewest = written.size() / 3 + 1;
  for (const std::string& name : names) {
    if (name.starts_with(written) && (!longer || name.size() < longer->size())) longer = name;
    if (const std::size_t slips = slips_between(written, name); slips < fewest) {
      fewest = slips;
      nearest = name;
    }
  }
  return nearest ? nearest : longer;
}

std::string meant(const std::string& written, const std::vector<std::string>& names, const std::string& prefix) {
  const auto nearest = nearest_name(written, names);
  return nearest ? "; did you mean " + prefix + *nearest + "?" : "";
}

}  // namespace priormap::cli
