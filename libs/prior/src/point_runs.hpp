#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "point_record.hpp"

namespace priormap {

/// Points that wait for their tile to be whole: those in a row that differ in their position alone, as the points of a face do, share their other columns and take
/// 12 bytes each instead of 32.

/// The bytes that `append_runs` adds; nothing where that is more than half of what the points take.
std::optional<std::size_t> bytes_of_runs(std::span<const PointRecord> points);
void append_runs(std::span<const PointRecord> points, std::vector<std::byte>& runs);
/// As many as fit at most: so much room `append_points` needs.
std::size_t most_points(std::span<const std::byte> runs);
void append_points(std::span<const std::byte> runs, std::vector<PointRecord>& points);

}  // namespace priormap
