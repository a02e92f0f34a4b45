#include "point_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
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

/// For each point the leading bits of (x, y, z) above its number: as many as fit and four passes sort. Few points share them.
struct PositionKeys {
  std::vector<std::uint64_t> keys;
  int index_bits = 0, position_bits = 0;

  explicit PositionKeys(const std::vector<PointRecord>& points) : keys(points.size()), index_bits(std::bit_width(points.size())) {
    Range x, y, z;
    for (const PointRecord& p : points) x.include(p.x), y.include(p.y), z.include(p.z);
    const int all_bits = x.bits() + y.bits() + z.bits();
    position_bits = std::min({all_bits, 4 * digit_bits, 64 - index_bits});
    const int dropped = all_bits - position_bits, dropped_xy = std::max(0, dropped - z.bits()), room_for_z = std::max(0, z.bits() - dropped);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint64_t xy = std::uint64_t(x.offset(points[i].x)) << y.bits() | y.offset(points[i].y);
      const std::uint64_t position = xy >> dropped_xy << room_for_z | std::uint64_t(z.offset(points[i].z)) >> dropped;
      keys[i] = position << index_bits | i;
    }
  }
  std::uint64_t position(std::size_t i) const { return keys[i] >> index_bits; }
  std::size_t index(std::size_t i) const { return keys[i] & ((std::uint64_t(1) << index_bits) - 1); }

  /// By position; least significant digit first. Digits that all keys share are skipped.
  void radix_sort() {
    constexpr std::size_t buckets = std::size_t(1) << digit_bits;
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

/// In order of position already, each position once.
bool is_sorted(const std::vector<PointRecord>& points) {
  const auto position = [](const PointRecord& p) { return std::tie(p.x, p.y, p.z); };
  return std::adjacent_find(points.begin(), points.end(), [&](const PointRecord& a, const PointRecord& b) { return position(a) >= position(b); }) == points.end();
}

}  // namespace

void sort_and_unite(std::vector<PointRecord>& points, std::vector<PointRecord>& sorted) {
  if (is_sorted(points)) return;
  PositionKeys order(points);
  constexpr std::size_t radix_pays = 256, ahead = 16;
  if (points.size() >= radix_pays)
    order.radix_sort();
  else
    std::sort(order.keys.begin(), order.keys.end());

  const std::size_t count = points.size();
  sorted.clear();
  sorted.reserve(count);
  for (std::size_t first = 0; first < count;) {
    const std::size_t start = sorted.size();
    std::size_t last = first;
    for (; last < count && order.position(last) == order.position(first); ++last) {
      if (last + ahead < count) __builtin_prefetch(&points[order.index(last + ahead)]);
      sorted.push_back(points[order.index(last)]);
    }
    if (last - first > 1) {
      const auto group = sorted.begin() + std::ptrdiff_t(start);
      std::sort(group, sorted.end());
      sorted.erase(std::unique(group, sorted.end(), same_point), sorted.end());
    }
    first = last;
  }
  points.swap(sorted);
}

}  // namespace priormap
