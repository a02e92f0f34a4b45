#include "outline_groups.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <numeric>
#include <sstream>

#include <priormap/builder/bounds_index.hpp>
#include <priormap/core/error.hpp>
#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {
namespace {

constexpr std::int64_t reach = 2;            // cells: 50 km of nothing at least between groups
constexpr std::int64_t cells_of_circle = 720;

void extend(Bounds2& a, const Bounds2& b) {
  a = {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x), std::max(a.max_y, b.max_y)};
}

/// Far larger than any building: a wrong digit, which says nothing of where the data lie.
bool is_implausible(const Bounds2& b, const Crs& crs) {
  constexpr double longest_m = 20'000, metres_per_degree = 111'320;
  const double unit_m = crs.is_geographic() ? metres_per_degree : crs.horizontal_unit_m();
  return !(std::max(b.max_x - b.min_x, b.max_y - b.min_y) * unit_m <= longest_m);
}

void unite(OutlineGroup& group, OutlineGroup&& other) {
  group.cells.merge(other.cells);
  group.count += other.count;
  group.area = united(*group.area, *other.area);
}

std::string text_of(const GeoPoint& place) {
  return (std::ostringstream() << std::fixed << std::setprecision(3) << "longitude " << place.lon_deg << ", latitude " << place.lat_deg).str();
}

/// Sets that are joined two at a time; each is named by its lowest member.
class Sets {
 public:
  explicit Sets(std::size_t size) : lower_(size) { std::iota(lower_.begin(), lower_.end(), std::size_t{0}); }
  std::size_t of(std::size_t i) {
    while (lower_[i] != i) i = lower_[i] = lower_[lower_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = of(a);
    b = of(b);
    lower_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> lower_;
};

}  // namespace

void PlaceBounds::extend(const Eigen::Vector2d& p) {
  const double x = p.x() < 0 ? p.x() + 360 : p.x();
  priormap::extend(as_they_are_, {p.x(), p.y(), p.x(), p.y()});
  priormap::extend(eastward_, {x, p.y(), x, p.y()});
}

void PlaceBounds::extend(const PlaceBounds& other) {
  priormap::extend(as_they_are_, other.as_they_are_);
  priormap::extend(eastward_, other.eastward_);
}

Bounds2 PlaceBounds::of(const Crs& crs) const {
  const bool crosses = crs.is_geographic() && eastward_.max_x - eastward_.min_x < as_they_are_.max_x - as_they_are_.min_x;
  return crosses ? eastward_ : as_they_are_;
}

OutlineGroup::Cell cell_at(std::uint32_t file, const Eigen::Vector2d& place, const Crs& crs) {
  constexpr double cell_deg = 360.0 / cells_of_circle, cell_m = 50'000;
  const double size = crs.is_geographic() ? cell_deg : cell_m / crs.horizontal_unit_m();
  const auto index = [size](double v) { return static_cast<std::int64_t>(std::floor(std::clamp(v / size, -1e15, 1e15))); };
  const std::int64_t x = index(place.x());
  return {file, crs.is_geographic() ? (x % cells_of_circle + cells_of_circle) % cells_of_circle : x, index(place.y())};
}

OutlineGroup::Cell cell_of(const Footprint& footprint, const Crs& crs) {
  const bool has_place = !footprint.rings.empty() && !footprint.rings.front().empty();
  return cell_at(footprint.file, has_place ? footprint.rings.front().front() : Eigen::Vector2d(0, 0), crs);
}

void GroupFinder::add(std::uint32_t file, const Crs& crs, const PlaceBounds& bounds, const Eigen::Vector2d& place, const std::string& id) {
  ++num_added_;
  if (bounds.is_empty() || is_implausible(bounds.of(crs), crs)) return;
  CellContent& content = cells_[cell_at(file, place, crs)];
  if (content.count++ == 0) content.first = id, content.first_at = num_added_, content.around_the_earth = crs.is_geographic();
  content.bounds.extend(bounds);
}

/// A cell and all that hang together with it.
std::pair<OutlineGroup, PlaceBounds> GroupFinder::take_group() {
  OutlineGroup group;
  PlaceBounds bounds;
  std::size_t first_at = std::numeric_limits<std::size_t>::max();
  std::vector<OutlineGroup::Cell> open{cells_.begin()->first};
  while (!open.empty()) {
    const OutlineGroup::Cell cell = open.back();
    open.pop_back();
    const auto found = cells_.find(cell);
    if (found == cells_.end()) continue;
    const CellContent content = std::move(found->second);
    cells_.erase(found);
    group.cells.insert(cell);
    group.count += content.count;
    group.file = cell.file;
    if (content.first_at < first_at) group.first = content.first, first_at = content.first_at;
    bounds.extend(content.bounds);
    for (std::int64_t dx = -reach; dx <= reach; ++dx)
      for (std::int64_t dy = -reach; dy <= reach; ++dy) {
        const std::int64_t x = cell.x + dx;
        open.push_back({cell.file, content.around_the_earth ? (x % cells_of_circle + cells_of_circle) % cells_of_circle : x, cell.y + dy});
      }
  }
  return {std::move(group), bounds};
}

bool GroupFinder::is_one_group() const {
  GroupFinder others = *this;
  if (!cells_.empty()) others.take_group();
  return others.cells_.empty();
}

std::vector<OutlineGroup> GroupFinder::finish(const std::function<std::optional<LonLatArea>(std::uint32_t file, const PlaceBounds&)>& area_of) {
  std::vector<OutlineGroup> somewhere, nowhere;
  std::vector<LonLatArea> areas;
  while (!cells_.empty()) {
    auto [group, bounds] = take_group();
    group.area = area_of(group.file, bounds);
    if (group.area) areas.push_back(*group.area);
    (group.area ? somewhere : nowhere).push_back(std::move(group));
  }
  const std::vector<std::size_t> lowest = near_each_other(areas);
  std::vector<OutlineGroup> groups;
  for (std::size_t i = 0; i < somewhere.size(); ++i)
    if (lowest[i] != i) unite(somewhere[lowest[i]], std::move(somewhere[i]));
  for (std::size_t i = 0; i < somewhere.size(); ++i)
    if (lowest[i] == i) groups.push_back(std::move(somewhere[i]));
  std::ranges::move(nowhere, std::back_inserter(groups));
  std::ranges::stable_sort(groups, std::ranges::greater{}, &OutlineGroup::count);
  return groups;
}

std::vector<std::size_t> near_each_other(std::span<const LonLatArea> areas) {
  // Areas that meet one square degree are near each other; only those of neighbouring squares have to be compared.
  constexpr double near_deg = 1;
  constexpr std::int64_t circle = 360;
  struct Filled {
    std::size_t area;
    Bounds2 part;    ///< of the square, from its corner
  };
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<Filled>> squares;   // longitude from 0 to 359, latitude
  Sets sets(areas.size());
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const double west = areas[i].west_deg, east = west + areas[i].width_deg();
    for (auto x = static_cast<std::int64_t>(std::floor(west)); static_cast<double>(x) <= east; ++x)
      for (auto y = static_cast<std::int64_t>(std::floor(areas[i].south_deg)); static_cast<double>(y) <= areas[i].north_deg; ++y) {
        const auto from = [](double v, std::int64_t corner) { return std::clamp(v - static_cast<double>(corner), 0.0, 1.0); };
        std::vector<Filled>& square = squares[{(x % circle + circle) % circle, y}];
        square.push_back({i, {from(west, x), from(areas[i].south_deg, y), from(east, x), from(areas[i].north_deg, y)}});
        sets.join(i, square.front().area);
      }
  }
  const auto come_near = [&](const std::vector<Filled>& square, const std::vector<Filled>& other, double x, double y) {
    return std::ranges::any_of(square, [&](const Filled& one) {
      return std::ranges::any_of(other, [&](const Filled& two) {
        return meet(grown(one.part, near_deg), {two.part.min_x + x, two.part.min_y + y, two.part.max_x + x, two.part.max_y + y});
      });
    });
  };
  for (const auto& [key, square] : squares)
    for (std::int64_t dx = -2; dx <= 2; ++dx)
      for (std::int64_t dy = -2; dy <= 2; ++dy) {
        const auto other = squares.find({(key.first + dx + circle) % circle, key.second + dy});
        if (other == squares.end() || sets.of(square.front().area) == sets.of(other->second.front().area)) continue;
        if (come_near(square, other->second, static_cast<double>(dx), static_cast<double>(dy))) sets.join(square.front().area, other->second.front().area);
      }
  std::vector<std::size_t> lowest(areas.size());
  for (std::size_t i = 0; i < areas.size(); ++i) lowest[i] = sets.of(i);
  return lowest;
}

SortedGroups sort_out(std::vector<OutlineGroup> groups) {
  constexpr double most = 0.9;
  std::size_t total = 0;
  for (const OutlineGroup& group : groups) total += group.count;
  const bool one_decides = groups.size() > 1 && static_cast<double>(groups.front().count) >= most * static_cast<double>(total);
  if (!one_decides) return {std::move(groups), {}};
  SortedGroups sorted{{}, {std::make_move_iterator(groups.begin() + 1), std::make_move_iterator(groups.end())}};
  sorted.main.push_back(std::move(groups.front()));
  return sorted;
}

std::vector<OutlineGroup> beyond_prior(const std::vector<OutlineGroup>& strays, const LonLatArea& main, const Crs& prior, const std::function<std::string(std::uint32_t file)>& file_name, const Events& events) {
  constexpr std::size_t most_named = 10;
  std::vector<OutlineGroup> beyond;
  for (std::size_t i = 0; i < strays.size(); ++i) {
    const OutlineGroup& stray = strays[i];
    const bool fits = stray.area && fits_lengths(prior, *stray.area);
    if (!fits) beyond.push_back(stray);
    if (i >= most_named) continue;
    const std::string others = stray.count > 1 ? " and " + std::to_string(stray.count - 1) + " more near it" : "";
    events.warn(file_name(stray.file) + ": " + stray.first + others + (stray.count > 1 ? " lie" : " lies") + (stray.area ? " at " + text_of(stray.area->middle()) : std::string(" nowhere on Earth")) +
                ", far from the rest (" + text_of(main.middle()) + "); " + (fits ? "kept, --bbox leaves out what is not wanted" : "left out, " + prior.horizontal().human_name() + " is not made for there"));
  }
  if (strays.size() > most_named) events.warn("and " + std::to_string(strays.size() - most_named) + " more places far from the rest");
  return beyond;
}

std::vector<OutlineGroup> outline_groups(const OutlineInput& input, const std::vector<InputCrs>& outlines) {
  GroupFinder finder;
  for (const Footprint& footprint : input.footprints) {
    PlaceBounds own;
    for (const Ring2& ring : footprint.rings)
      for (const Eigen::Vector2d& p : ring) own.extend(p);
    const bool has_place = !footprint.rings.empty() && !footprint.rings.front().empty();
    finder.add(footprint.file, outlines[footprint.file].crs, own, has_place ? footprint.rings.front().front() : Eigen::Vector2d(0, 0), footprint.id);
  }
  return finder.finish([&](std::uint32_t file, const PlaceBounds& bounds) { return lon_lat_area(bounds.of(outlines[file].crs), outlines[file].crs); });
}

}  // namespace priormap
