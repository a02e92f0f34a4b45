#include "point_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace priormap {
namespace {

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

struct Range {
  std::int32_t low = INT32_MAX, high = INT32_MIN;
  void include(std::int32_t v) { low = std::min(low, v), high = std::max(high, v); }
  int bits() const { return std::bit_width(std::uint32_t(std::int64_t(high) - low)); }
};

/// Keys whose order is that of (x, y, z), as far as 64 bits reach, in as few bits as the extent of the points needs.
std::vector<Keyed> position_keys(const std::vector<PointRecord>& points, int& key_bits) {
  Range x, y, z;
  for (const PointRecord& p : points) x.include(p.x), y.include(p.y), z.include(p.z);
  const int dropped_z_bits = std::max(0, x.bits() + y.bits() + z.bits() - 64);
  const int z_bits = z.bits() - dropped_z_bits, yz_bits = y.bits() + z_bits;
  key_bits = x.bits() + yz_bits;
  std::vector<Keyed> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointRecord& p = points[i];
    const auto offset = [](std::int32_t v, const Range& range) { return std::uint64_t(std::int64_t(v) - range.low); };
    keys[i] = {(offset(p.x, x) << yz_bits) | (offset(p.y, y) << z_bits) | (offset(p.z, z) >> dropped_z_bits), std::uint32_t(i)};
  }
  return keys;
}

/// Least significant digit first, stable; digits that all keys share are skipped.
void radix_sort(std::vector<Keyed>& keys, int key_bits) {
  constexpr int digit_bits = 11;
  constexpr std::size_t buckets = std::size_t(1) << digit_bits;
  std::vector<Keyed> sorted(keys.size());
  for (int shift = 0; shift < key_bits; shift += digit_bits) {
    std::array<std::uint32_t, buckets> start{};
    for (const Keyed& k : keys) ++start[(k.key >> shift) & (buckets - 1)];
    if (start[(keys[0].key >> shift) & (buckets - 1)] == keys.size()) continue;
    std::uint32_t sum = 0;
    for (std::uint32_t& s : start) sum += std::exchange(s, sum);
    for (const Keyed& k : keys) sorted[start[(k.key >> shift) & (buckets - 1)]++] = k;
    keys.swap(sorted);
  }
}

/// In order of position already, each position once.
bool is_sorted(const std::vector<PointRecord>& points) {
  const auto position = [](const PointRecord& p) { return std::tie(p.x, p.y, p.z); };
  return std::adjacent_find(points.begin(), points.end(), [&](const PointRecord& a, const PointRecord& b) { return position(a) >= position(b); }) == points.end();
}

}  // namespace

void sort_and_unite(std::vector<PointRecord>& points) {
  if (is_sorted(points)) return;
  int key_bits = 0;
  std::vector<Keyed> keys = position_keys(points, key_bits);
  constexpr std::size_t radix_pays = 256;
  if (keys.size() >= radix_pays)
    radix_sort(keys, key_bits);
  else
    std::sort(keys.begin(), keys.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });

  std::vector<PointRecord> sorted;
  sorted.reserve(points.size());
  for (std::size_t first = 0; first < keys.size();) {
    const std::size_t start = sorted.size();
    std::size_t last = first;
    for (; last < keys.size() && keys[last].key == keys[first].key; ++last) sorted.push_back(points[keys[last].index]);
    if (last - first > 1) {
      const auto group = sorted.begin() + std::ptrdiff_t(start);
      std::sort(group, sorted.end());
      sorted.erase(std::unique(group, sorted.end(), same_point), sorted.end());
    }
    first = last;
  }
  points = std::move(sorted);
}

}  // namespace priormap
