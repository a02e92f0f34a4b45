#include "point_runs.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace priormap {
namespace {

static_assert(std::is_trivially_copyable_v<PointRecord>);
constexpr std::size_t position_bytes = offsetof(PointRecord, normal), other_bytes = sizeof(PointRecord) - position_bytes;
static_assert(position_bytes == 12 && other_bytes == 20);

/// A run: how many points, what they share, their positions.
using Count = std::uint32_t;
constexpr std::size_t head_bytes = sizeof(Count) + other_bytes;

const std::byte* others_of(const PointRecord& point) { return reinterpret_cast<const std::byte*>(&point) + position_bytes; }
bool share_others(const PointRecord& a, const PointRecord& b) { return std::memcmp(others_of(a), others_of(b), other_bytes) == 0; }

}  // namespace

std::optional<std::size_t> bytes_of_runs(std::span<const PointRecord> points) {
  const std::size_t most = points.size() * (sizeof(PointRecord) / 2 - position_bytes) / head_bytes;
  std::size_t runs = 1;
  for (std::size_t i = 1; i < points.size() && runs <= most; ++i) runs += !share_others(points[i - 1], points[i]);
  return runs <= most ? std::optional(runs * head_bytes + points.size() * position_bytes) : std::nullopt;
}

void append_runs(std::span<const PointRecord> points, std::vector<std::byte>& runs) {
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first + 1;
    while (last < points.size() && share_others(points[first], points[last])) ++last;
    const std::size_t start = runs.size();
    runs.resize(start + head_bytes + (last - first) * position_bytes);
    std::byte* to = runs.data() + start;
    const auto count = Count(last - first);
    std::memcpy(to, &count, sizeof(Count));
    std::memcpy(to + sizeof(Count), others_of(points[first]), other_bytes);
    to += head_bytes;
    for (; first < last; ++first, to += position_bytes) std::memcpy(to, &points[first], position_bytes);
  }
}

std::size_t most_points(std::span<const std::byte> runs) { return runs.size() / position_bytes; }

void append_points(std::span<const std::byte> runs, std::vector<PointRecord>& points) {
  while (!runs.empty()) {
    Count count;
    PointRecord point;
    std::memcpy(&count, runs.data(), sizeof(Count));
    std::memcpy(reinterpret_cast<std::byte*>(&point) + position_bytes, runs.data() + sizeof(Count), other_bytes);
    const std::byte* from = runs.data() + head_bytes;
    for (Count i = 0; i < count; ++i, from += position_bytes) std::memcpy(reinterpret_cast<std::byte*>(&points.emplace_back(point)), from, position_bytes);
    runs = runs.subspan(head_bytes + count * position_bytes);
  }
}

}  // namespace priormap
