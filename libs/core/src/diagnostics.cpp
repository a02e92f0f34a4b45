#include <priormap/core/diagnostics.hpp>

#include <algorithm>
#include <utility>

namespace priormap {

void Diagnostics::keep(Ranked entry) {
  auto& kept = entries_[entry.entry.code];
  const auto at = std::ranges::upper_bound(kept, entry.rank, {}, &Ranked::rank);
  if (kept.size() == max_entries && at == kept.end()) return;
  kept.insert(at, std::move(entry));
  if (kept.size() > max_entries) kept.pop_back();
}

void Diagnostics::add(DiagnosticCode code, std::string feature, std::string message) {
  ++counts_[code];
  keep({rank_, {code, std::move(feature), std::move(message)}});
}

void Diagnostics::merge(const Diagnostics& other) {
  for (const auto& [code, count] : other.counts_) counts_[code] += count;
  for (const auto& [code, theirs] : other.entries_)
    for (const Ranked& entry : theirs) keep(entry);
}

std::vector<Diagnostics::Entry> Diagnostics::entries() const {
  std::vector<Entry> all;
  for (const auto& [code, kept] : entries_)
    for (const Ranked& ranked : kept) all.push_back(ranked.entry);
  return all;
}

std::size_t Diagnostics::total() const {
  std::size_t sum = 0;
  for (const auto& [code, count] : counts_) sum += count;
  return sum;
}

}  // namespace priormap
