#include "outline_groups.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include <priormap/builder/bounds_index.hpp>
#include <priormap/core/error.hpp>
#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {
namespace {

constexpr std::int64_t reach = 2;            // cells: 50 km of nothing at least between groups
constexpr std::int64_t cells_of_circle = 720;
constexpr double near_deg = 1;               // groups of several files: as one

/// Around places, by x as it is and by x counted eastward from 0: of longitudes that cross the antimeridian the second is narrower.
struct PlaceBounds {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds2 as_they_are{infinity, infinity, -infinity, -infinity}, eastward = as_they_are;

  void extend(const Eigen::Vector2d& p) {
    const double x = p.x() < 0 ? p.x() + 360 : p.x();
    extend(as_they_are, {p.x(), p.y(), p.x(), p.y()});
    extend(eastward, {x, p.y(), x, p.y()});
  }
  void extend(const PlaceBounds& other) {
    extend(as_they_are, other.as_they_are);
    extend(eastward, other.eastward);
  }
  Bounds2 of(const Crs& crs) const {
    const bool crosses = crs.is_geographic() && eastward.max_x - eastward.min_x < as_they_are.max_x - as_they_are.min_x;
    return crosses ? eastward : as_they_are;
  }

 private:
  static void extend(Bounds2& a, const Bounds2& b) {
    a = {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x), std::max(a.max_y, b.max_y)};
  }
};

/// Far larger than any building: a wrong digit, which says nothing of where the data lie.
bool is_implausible(const Bounds2& b, const Crs& crs) {
  constexpr double longest_m = 20'000, metres_per_degree = 111'320;
  const double unit_m = crs.is_geographic() ? metres_per_degree : crs.horizontal_unit_m();
  return !(std::max(b.max_x - b.min_x, b.max_y - b.min_y) * unit_m <= longest_m);
}

struct CellContent {
  std::size_t count = 0;
  std::string first;
  std::size_t first_at = 0;   ///< in the input
  PlaceBounds bounds;
};
using Cells = std::map<OutlineGroup::Cell, CellContent>;

Cells cells_of(const OutlineInput& input, const std::vector<InputCrs>& outlines) {
  Cells cells;
  std::size_t at = 0;
  for (const Footprint& footprint : input.footprints) {
    ++at;
    PlaceBounds own;
    for (const Ring2& ring : footprint.rings)
      for (const Eigen::Vector2d& p : ring) own.extend(p);
    const Crs& crs = outlines[footprint.file].crs;
    const bool has_places = own.as_they_are.min_x <= own.as_they_are.max_x;
    if (!has_places || is_implausible(own.of(crs), crs)) continue;
    CellContent& content = cells[cell_of(footprint, crs)];
    if (content.count++ == 0) content.first = footprint.id, content.first_at = at;
    content.bounds.extend(own);
  }
  return cells;
}

/// Takes a cell and all that hang together with it out of `cells`.
std::pair<OutlineGroup, PlaceBounds> take_group(Cells& cells, bool around_the_earth) {
  OutlineGroup group;
  PlaceBounds bounds;
  std::size_t first_at = std::numeric_limits<std::size_t>::max();
  std::vector<OutlineGroup::Cell> open{cells.begin()->first};
  while (!open.empty()) {
    const OutlineGroup::Cell cell = open.back();
    open.pop_back();
    const auto found = cells.find(cell);
    if (found == cells.end()) continue;
    const CellContent content = std::move(found->second);
    cells.erase(found);
    group.cells.insert(cell);
    group.count += content.count;
    group.file = cell.file;
    if (content.first_at < first_at) group.first = content.first, first_at = content.first_at;
    bounds.extend(content.bounds);
    for (std::int64_t dx = -reach; dx <= reach; ++dx)
      for (std::int64_t dy = -reach; dy <= reach; ++dy) {
        const std::int64_t x = cell.x + dx;
        open.push_back({cell.file, around_the_earth ? (x % cells_of_circle + cells_of_circle) % cells_of_circle : x, cell.y + dy});
      }
  }
  return {std::move(group), bounds};
}

bool are_near(const OutlineGroup& a, const OutlineGroup& b) {
  if (!a.area || !b.area) return false;
  const auto reaches = [](const LonLatArea& area, const LonLatArea& other) {
    return std::ranges::any_of(other.corners(), [&](const GeoPoint& corner) { return area.degrees_outside(corner) <= near_deg; }) || area.degrees_outside(other.middle()) <= near_deg;
  };
  return reaches(*a.area, *b.area) || reaches(*b.area, *a.area);
}

void unite(OutlineGroup& group, const OutlineGroup& other) {
  group.cells.insert(other.cells.begin(), other.cells.end());
  group.count += other.count;
  group.area = united(*group.area, *other.area);
}

}  // namespace

OutlineGroup::Cell cell_of(const Footprint& footprint, const Crs& crs) {
  constexpr double cell_deg = 360.0 / cells_of_circle, cell_m = 50'000;
  const Eigen::Vector2d place = footprint.rings.empty() || footprint.rings.front().empty() ? Eigen::Vector2d(0, 0) : footprint.rings.front().front();
  const double size = crs.is_geographic() ? cell_deg : cell_m / crs.horizontal_unit_m();
  const auto index = [size](double v) { return static_cast<std::int64_t>(std::floor(std::clamp(v / size, -1e15, 1e15))); };
  const std::int64_t x = index(place.x());
  return {footprint.file, crs.is_geographic() ? (x % cells_of_circle + cells_of_circle) % cells_of_circle : x, index(place.y())};
}

std::vector<OutlineGroup> outline_groups(const OutlineInput& input, const std::vector<InputCrs>& outlines) {
  Cells cells = cells_of(input, outlines);
  std::vector<OutlineGroup> groups, nowhere;   // the latter may be as many as there are outlines
  while (!cells.empty()) {
    const Crs& crs = outlines[cells.begin()->first.file].crs;
    auto [group, bounds] = take_group(cells, crs.is_geographic());
    const Bounds2 own = bounds.of(crs);
    group.area = lon_lat_area(own, crs);
    if (!group.area) {
      nowhere.push_back(std::move(group));
      continue;
    }
    groups.push_back(std::move(group));
    // A group that is near several others joins them all.
    for (std::size_t i = 0; i + 1 < groups.size();) {
      if (!are_near(groups[i], groups.back())) {
        ++i;
        continue;
      }
      OutlineGroup joined = std::move(groups[i]);
      unite(joined, groups.back());
      groups.pop_back();
      groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(i));
      groups.push_back(std::move(joined));
      i = 0;
    }
  }
  std::ranges::move(nowhere, std::back_inserter(groups));
  std::ranges::stable_sort(groups, std::ranges::greater{}, &OutlineGroup::count);
  return groups;
}

}  // namespace priormap
