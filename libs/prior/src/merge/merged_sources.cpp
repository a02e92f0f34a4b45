#include "merge/merged_sources.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

constexpr const char* separator = "; ";

void insert_parts(std::set<std::string>& parts, const std::string& text) {
  for (std::size_t first = 0; first < text.size();) {
    const std::size_t last = std::min(text.find(separator, first), text.size());
    parts.insert(text.substr(first, last - first));
    first = last + 2;
  }
}

/// What either says, each part once: no attribution is lost, and the order of the priors does not matter.
std::string united(const std::string& a, const std::string& b) {
  if (a == b) return a;
  std::set<std::string> parts;
  insert_parts(parts, a);
  insert_parts(parts, b);
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

void unite(PriorSource& source, const PriorSource& other) {
  source.license = united(source.license, other.license);
  source.attribution = united(source.attribution, other.attribution);
  source.date = united(source.date, other.date);
  source.assumed_vertical = united(source.assumed_vertical, other.assumed_vertical);
  source.kind = std::min(source.kind, other.kind);
  source.file_name = std::min(source.file_name, other.file_name);
  source.crs = std::min(source.crs, other.crs);
  if (std::tie(other.operation.name, other.operation.proj_string) < std::tie(source.operation.name, source.operation.proj_string))
    source.operation = other.operation;
  if (other.sigma_m) source.sigma_m = std::max(source.sigma_m.value_or(0), *other.sigma_m);
  std::erase_if(source.facts, [&](const auto& fact) { return std::ranges::count(other.facts, fact) == 0; });
}

/// Different files that were given one id keep it with a piece of their digest.
void make_ids_unique(std::vector<PriorSource>& sources) {
  std::map<std::string, int> uses;
  for (const PriorSource& source : sources) ++uses[source.id];
  std::set<std::string> ids;
  for (PriorSource& source : sources) {
    if (uses[source.id] > 1) source.id += "-" + source.sha256.substr(0, 8);
    if (!ids.insert(source.id).second) throw FormatError("two sources are named " + source.id + "; make one of the priors again");
  }
}

/// Where a source stands: named in `precedence`, then by prior, then as that prior was merged.
using Rank = std::tuple<std::size_t, std::size_t, int>;

std::size_t named_rank(const PriorSource& source, std::span<const std::string> precedence) {
  const auto by_id = std::ranges::find(precedence, source.id);
  const auto found = by_id != precedence.end() ? by_id : std::ranges::find(precedence, source.kind);
  return std::size_t(found - precedence.begin());
}

void check_names(std::span<const PriorManifest> priors, std::span<const std::string> precedence) {
  for (const std::string& name : precedence) {
    const auto has_name = [&](const PriorSource& source) { return source.id == name || source.kind == name; };
    if (std::ranges::none_of(priors, [&](const PriorManifest& prior) { return std::ranges::any_of(prior.sources, has_name); }))
      throw UsageError("--precedence " + name + ": no source of the priors has this id or kind; priorinfo lists them");
  }
}

}  // namespace

MergedSources merge_sources(std::span<const PriorManifest> priors, std::span<const std::string> precedence) {
  check_names(priors, precedence);
  MergedSources merged;
  std::vector<Rank> ranks;
  std::map<std::pair<std::string, std::string>, std::uint16_t> position;   // of (id, sha256)
  for (std::size_t i = 0; i < priors.size(); ++i) {
    merged.index_of_input.emplace_back();
    for (const PriorSource& source : priors[i].sources) {
      const Rank rank{named_rank(source, precedence), i, source.precedence};
      const auto [found, is_new] = position.try_emplace({source.id, source.sha256}, std::uint16_t(merged.sources.size()));
      if (is_new) {
        if (merged.sources.size() == 65535) throw UsageError("a prior holds at most 65535 sources; merge fewer priors");
        merged.sources.push_back(source);
        ranks.push_back(rank);
      } else {
        unite(merged.sources[found->second], source);
        ranks[found->second] = std::min(ranks[found->second], rank);
      }
      merged.index_of_input.back().push_back(found->second);
    }
  }
  const std::set<Rank> levels(ranks.begin(), ranks.end());
  for (std::size_t s = 0; s < ranks.size(); ++s)
    merged.sources[s].precedence = int(std::distance(levels.begin(), levels.find(ranks[s])));
  make_ids_unique(merged.sources);
  return merged;
}

}  // namespace priormap
