#include "point_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>

namespace priormap {
namespace {

constexpr int digit_bits = 11;

struct Range {
  std::int32_t low = INT32_MAX, high = INT32_MIN;
  void include(std::int32_t v) { low = std::min(low, v), high = std::max(high, v); }
  std::uint32_t offset(std::int32_t v) const { return std::uint32_t(std::int64_t(v) - low); }
  int bits() const { return std::bit_width(offset(high)); }
};

/// Points in a row above each other or below: walls come as such, and are sorted as one.
struct Stacks {
  std::vector<std::uint32_t> first;   ///< of each; one more at the end

  explicit Stacks(const std::vector<PointRecord>& points) {
    first.reserve(points.size() / 2 + 1);
    for (std::size_t i = 0; i < points.size();) {
      first.push_back(std::uint32_t(i));
      const PointRecord& p = points[i++];
      if (i == points.size() || !is_above(points[i], p)) continue;
      const bool up = points[i].z > p.z;
      for (++i; i < points.size() && is_above(points[i], p) && points[i].z != points[i - 1].z && (points[i].z > points[i - 1].z) == up;) ++i;
    }
    first.push_back(std::uint32_t(points.size()));
  }
  std::size_t size() const { return first.size() - 1; }

 private:
  static bool is_above(const PointRecord& a, const PointRecord& b) { return a.x == b.x && a.y == b.y && a.z != b.z; }
};

/// For each stack the leading bits of (x, y) above its number: as many as fit and four passes sort.
struct StackKeys {
  std::vector<std::uint64_t> keys;
  int index_bits = 0, position_bits = 0;

  StackKeys(const std::vector<PointRecord>& points, const Stacks& stacks) : keys(stacks.size()), index_bits(std::bit_width(stacks.size())) {
    Range x, y;
    for (std::size_t i = 0; i < keys.size(); ++i) x.include(points[stacks.first[i]].x), y.include(points[stacks.first[i]].y);
    const int all_bits = x.bits() + y.bits();
    position_bits = std::min({all_bits, 4 * digit_bits, 64 - index_bits});
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const PointRecord& p = points[stacks.first[i]];
      keys[i] = (std::uint64_t(x.offset(p.x)) << y.bits() | y.offset(p.y)) >> (all_bits - position_bits) << index_bits | i;
    }
  }
  std::uint64_t position(std::size_t i) const { return keys[i] >> index_bits; }
  std::size_t index(std::size_t i) const { return keys[i] & ((std::uint64_t(1) << index_bits) - 1); }

  /// By position; least significant digit first. Digits that all keys share are skipped.
  void sort() {
    constexpr std::size_t radix_pays = 256, buckets = std::size_t(1) << digit_bits;
    if (keys.size() < radix_pays) return std::sort(keys.begin(), keys.end());
    std::vector<std::uint64_t> sorted(keys.size());
    for (int shift = index_bits; shift < index_bits + position_bits; shift += digit_bits) {
      std::array<std::uint32_t, buckets> start{};
      for (const std::uint64_t k : keys) ++start[(k >> shift) & (buckets - 1)];
      if (start[(keys[0] >> shift) & (buckets - 1)] == keys.size()) continue;
      std::uint32_t sum = 0;
      for (std::uint32_t& s : start) sum += std::exchange(s, sum);
      for (const std::uint64_t k : keys) sorted[start[(k >> shift) & (buckets - 1)]++] = k;
      keys.swap(sorted);
    }
  }
};

/// Without a branch: which of x, y and z decides is as good as random.
bool is_before(const PointRecord& a, const PointRecord& b) { return (a.x < b.x) | ((a.x == b.x) & ((a.y < b.y) | ((a.y == b.y) & (a.z < b.z)))); }

/// In order of position already, each position once.
bool is_sorted(std::span<const PointRecord> points) {
  return std::ranges::adjacent_find(points, [](const PointRecord& a, const PointRecord& b) { return !is_before(a, b); }) == points.end();
}

void append_upwards(std::span<const PointRecord> stack, std::vector<PointRecord>& points) {
  if (stack.size() == 1)
    points.push_back(stack.front());
  else if (stack.front().z < stack.back().z)
    points.insert(points.end(), stack.begin(), stack.end());
  else
    points.insert(points.end(), stack.rbegin(), stack.rend());
}

/// Keeps the points from `start` on in order. @return whether it took more than appending
bool merge_upwards(std::span<const PointRecord> stack, std::size_t start, std::vector<PointRecord>& points) {
  const auto middle = std::ptrdiff_t(points.size());
  append_upwards(stack, points);
  const auto from = points.begin() + std::ptrdiff_t(start), to = points.begin() + middle;
  if (from == to || is_before(*(to - 1), *to)) return false;
  std::inplace_merge(std::lower_bound(from, to, *to), to, points.end());
  return true;
}

}  // namespace

void sort_and_unite(std::vector<PointRecord>& points, std::vector<PointRecord>& sorted) {
  if (is_sorted(points)) return;
  const Stacks stacks(points);
  StackKeys order(points, stacks);
  order.sort();

  constexpr std::size_t ahead = 16;
  const std::size_t count = stacks.size();
  const auto stack = [&](std::size_t number) { return std::span(points).subspan(stacks.first[number], stacks.first[number + 1] - stacks.first[number]); };
  const auto lowest = [&](std::uint32_t number) { return std::min(stack(number).front().z, stack(number).back().z); };
  std::vector<std::uint32_t> group;
  sorted.clear();
  sorted.reserve(points.size());
  for (std::size_t first = 0; first < count;) {
    group.clear();
    std::size_t last = first;
    for (; last < count && order.position(last) == order.position(first); ++last) {
      if (last + ahead < count) __builtin_prefetch(&points[stacks.first[order.index(last + ahead)]]);
      group.push_back(std::uint32_t(order.index(last)));
    }
    first = last;
    if (group.size() == 1) {
      append_upwards(stack(group.front()), sorted);
      continue;
    }
    // Mostly a foot, a wall and what lies on top of it: in order once they are one upon the other. Where walls meet at a corner both bring its edge.
    std::ranges::sort(group, {}, lowest);
    const std::size_t start = sorted.size();
    bool are_merged = false;
    for (const std::uint32_t number : group) are_merged |= merge_upwards(stack(number), start, sorted);
    if (are_merged) sorted.erase(std::unique(sorted.begin() + std::ptrdiff_t(start), sorted.end(), same_point), sorted.end());
  }
  points.swap(sorted);
}

}  // namespace priormap
