#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <priormap/builder/outline_prior.hpp>
#include <priormap/builder/prior_crs.hpp>
#include <priormap/geodesy/lon_lat_area.hpp>

namespace priormap {

/// Footprints that lie together: between two groups are 50 km of nothing at least.
struct OutlineGroup {
  /// Squares of half a degree or of 50 km in the CRS of a file.
  struct Cell {
    std::uint16_t file;
    std::int64_t x, y;
    auto operator<=>(const Cell&) const = default;
  };

  std::set<Cell> cells;
  std::size_t count = 0;
  std::string first;                 ///< of their ids, in the order of the input
  std::uint16_t file = 0;            ///< of the first
  std::optional<LonLatArea> area;    ///< nothing: outside the domain of their CRS
};

/// The largest first. Footprints far larger than any building say nothing of where the data lie, and are in none.
/// @param outlines  by file
std::vector<OutlineGroup> outline_groups(const OutlineInput& input, const std::vector<InputCrs>& outlines);

/// Where a footprint of a file belongs.
OutlineGroup::Cell cell_of(const Footprint& footprint, const Crs& crs);

}  // namespace priormap
