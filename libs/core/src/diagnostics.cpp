#include <priormap/core/diagnostics.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace priormap {

void Diagnostics::add(DiagnosticCode code, std::string feature, std::string message) {
  ++counts_[code];
  auto& kept = entries_[code];
  if (kept.size() < max_entries) kept.push_back({code, std::move(feature), std::move(message)});
}

void Diagnostics::merge(const Diagnostics& other) {
  for (const auto& [code, count] : other.counts_) counts_[code] += count;
  for (const auto& [code, theirs] : other.entries_) {
    auto& kept = entries_[code];
    const std::size_t room = std::min(theirs.size(), max_entries - kept.size());
    std::copy_n(theirs.begin(), room, std::back_inserter(kept));
  }
}

std::vector<Diagnostics::Entry> Diagnostics::entries() const {
  std::vector<Entry> all;
  for (const auto& [code, kept] : entries_) all.insert(all.end(), kept.begin(), kept.end());
  return all;
}

std::size_t Diagnostics::total() const {
  std::size_t sum = 0;
  for (const auto& [code, count] : counts_) sum += count;
  return sum;
}

}  // namespace priormap
