#include <priormap/builder/bounds_index.hpp>

#include <algorithm>
#include <cmath>

namespace priormap {
namespace {

constexpr double cell_m = 64;

template <class Visitor>
void for_each_cell(const Bounds2& bounds, const Visitor& visit) {
  const auto index = [](double v) { return static_cast<std::int32_t>(std::floor(v / cell_m)); };
  for (std::int32_t x = index(bounds.min_x); x <= index(bounds.max_x); ++x)
    for (std::int32_t y = index(bounds.min_y); y <= index(bounds.max_y); ++y) visit(std::pair(x, y));
}

}  // namespace

void BoundsIndex::add(const Bounds2& bounds, std::uint32_t value) {
  const auto i = static_cast<std::uint32_t>(bounds_.size());
  bounds_.push_back(bounds);
  values_.push_back(value);
  for_each_cell(bounds, [&](const Cell& cell) { entries_.emplace_back(cell, i); });
}

void BoundsIndex::sort() { std::ranges::sort(entries_); }

std::vector<std::uint32_t> BoundsIndex::meeting(const Bounds2& bounds) const {
  std::vector<std::uint32_t> found;
  for_each_cell(bounds, [&](const Cell& cell) {
    for (auto entry = std::ranges::lower_bound(entries_, std::pair(cell, std::uint32_t(0))); entry != entries_.end() && entry->first == cell; ++entry)
      if (meet(bounds, bounds_[entry->second])) found.push_back(values_[entry->second]);
  });
  std::ranges::sort(found);
  const auto repeated = std::ranges::unique(found);
  found.erase(repeated.begin(), repeated.end());
  return found;
}

}  // namespace priormap
