#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <priormap/builder/outline_prior.hpp>
#include <priormap/builder/prior_crs.hpp>
#include <priormap/geodesy/lon_lat_area.hpp>

namespace priormap {

/// Footprints, or building models, that lie together: between two groups are 50 km of nothing at least.
struct OutlineGroup {
  /// Squares of half a degree or of 50 km in the CRS of a file.
  struct Cell {
    std::uint32_t file;
    std::int64_t x, y;
    auto operator<=>(const Cell&) const = default;
  };

  std::set<Cell> cells;
  std::size_t count = 0;
  std::string first;                 ///< of their ids, in the order of the input
  std::uint32_t file = 0;            ///< of the first
  std::optional<LonLatArea> area;    ///< nothing: outside the domain of their CRS
};

/// Around places, by x as it is and by x counted eastward from 0: of longitudes that cross the antimeridian the second is narrower.
class PlaceBounds {
 public:
  void extend(const Eigen::Vector2d& p);
  void extend(const PlaceBounds& other);
  bool is_empty() const { return !(as_they_are_.min_x <= as_they_are_.max_x); }
  Bounds2 of(const Crs& crs) const;

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds2 as_they_are_{infinity, infinity, -infinity, -infinity}, eastward_ = as_they_are_;
};

/// Gathers what a file holds into groups.
class GroupFinder {
 public:
  /// What is far larger than any building says nothing of where the data lie, and is in no group. @param place  of it, by which `cell_at` finds its cell
  void add(std::uint32_t file, const Crs& crs, const PlaceBounds& bounds, const Eigen::Vector2d& place, const std::string& id);
  /// Whether there is one group at most, by the cells alone.
  bool is_one_group() const;
  /// Once. The largest first.
  /// @param area_of  where a rectangle of a file lies
  std::vector<OutlineGroup> finish(const std::function<std::optional<LonLatArea>(std::uint32_t file, const PlaceBounds&)>& area_of);

 private:
  struct CellContent {
    std::size_t count = 0;
    std::string first;
    std::size_t first_at = 0;   ///< in the input
    PlaceBounds bounds;
    bool around_the_earth = false;
  };
  std::pair<OutlineGroup, PlaceBounds> take_group();

  std::size_t num_added_ = 0;
  std::map<OutlineGroup::Cell, CellContent> cells_;
};

/// The groups that decide where the prior lies, and those far away from them.
struct SortedGroups {
  std::vector<OutlineGroup> main, strays;
};

/// A group that holds nine tenths decides alone: what lies far off is a slip of somebody's hand, or elsewhere.
SortedGroups sort_out(std::vector<OutlineGroup> groups);

/// Of the strays those that the prior's CRS does not reach, or where it makes lengths wrong; says of all where they lie.
/// @param file_name  of the first of a group
std::vector<OutlineGroup> beyond_prior(const std::vector<OutlineGroup>& strays, const LonLatArea& main, const Crs& prior, const std::function<std::string(std::uint32_t file)>& file_name,
                                       const Events& events);

/// Groups of areas that come within a degree of each other, by way of others or not: for each the lowest index of its group.
std::vector<std::size_t> near_each_other(std::span<const LonLatArea> areas);

/// The largest first. @param outlines  by file
std::vector<OutlineGroup> outline_groups(const OutlineInput& input, const std::vector<InputCrs>& outlines);

OutlineGroup::Cell cell_at(std::uint32_t file, const Eigen::Vector2d& place, const Crs& crs);
/// Where a footprint of a file belongs.
OutlineGroup::Cell cell_of(const Footprint& footprint, const Crs& crs);

}  // namespace priormap
