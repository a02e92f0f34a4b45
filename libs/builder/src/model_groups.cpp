#include "model_groups.hpp"

#include <priormap/builder/prior_crs.hpp>

#include "model_axes.hpp"

namespace priormap {
namespace {

bool has_points(const BuildingModel& model) {
  for (const ModelPolygon& polygon : model.polygons)
    if (!polygon.polygon.exterior.empty()) return true;
  return false;
}

}  // namespace

void ModelGroups::add(const BuildingModel& model, const std::string& file) {
  if (!has_points(model)) return;
  const Key key{model.srs_name, file};
  const auto [number, is_new] = numbers_.try_emplace(key, static_cast<std::uint32_t>(crs_.size()));
  if (is_new) {
    crs_.push_back(resolve_input_crs(options_, declared_crs(model.srs_name, file, !options_.source_crs.empty()), file, {}).crs.horizontal());
    keys_.push_back(key);
  }
  const Crs& crs = crs_[number->second];
  PlaceBounds bounds;
  for (const ModelPolygon& polygon : model.polygons)
    for (const Eigen::Vector3d& p : polygon.polygon.exterior) bounds.extend(p.head<2>());
  const Eigen::Vector3d place = first_point(model, file);
  const OutlineGroup::Cell cell = cell_at(number->second, place.head<2>(), crs);
  if (first_in_cell_.try_emplace(cell, place).second) cells_.push_back(cell);
  finder_.add(number->second, crs, bounds, place.head<2>(), model.id);
}

bool ModelGroups::finish() {
  if (finder_.is_one_group()) return false;   // and none need know where it lies
  const auto area_of = [&](std::uint32_t number, const PlaceBounds& bounds) {
    const Crs& crs = crs_[number];
    const Bounds2 b = bounds.of(crs);
    const bool swap = northing_comes_first(keys_[number].first, crs, {0.5 * (b.min_x + b.max_x), 0.5 * (b.min_y + b.max_y), 0});
    return lon_lat_area(swap ? Bounds2{b.min_y, b.min_x, b.max_y, b.max_x} : b, crs);
  };
  groups_ = sort_out(finder_.finish(area_of));
  if (groups_.strays.empty() || !groups_.main.front().area) return false;
  std::erase_if(cells_, [&](const OutlineGroup::Cell& cell) { return !groups_.main.front().cells.contains(cell); });
  for (const OutlineGroup::Cell& cell : cells_) deciding_.try_emplace(keys_[cell.file], first_in_cell_.at(cell));
  return true;
}

ModelFrames ModelGroups::frames(const Events& events) const {
  const auto& [srs_name, file] = keys_[cells_.front().file];
  return ModelFrames(options_, srs_name, first_in_cell_.at(cells_.front()), file, deciding_, events);
}

std::optional<OutlineGroup::Cell> ModelGroups::cell_of(const BuildingModel& model, const std::string& file) const {
  const auto number = numbers_.find({model.srs_name, file});
  if (number == numbers_.end() || !has_points(model)) return std::nullopt;
  return cell_at(number->second, first_point(model, file).head<2>(), crs_[number->second]);
}

void ModelGroups::leave_out_beyond(const Crs& prior, const Events& events) {
  if (groups_.strays.empty() || !options_.bbox.empty()) return;
  for (const OutlineGroup& stray : beyond_prior(groups_.strays, *groups_.main.front().area, prior, [&](std::uint32_t number) { return keys_[number].second; }, events))
    left_out_.insert(stray.cells.begin(), stray.cells.end());
}

bool ModelGroups::leaves_out(const BuildingModel& model, const std::string& file) const {
  if (left_out_.empty()) return false;
  const auto cell = cell_of(model, file);
  return cell && left_out_.contains(*cell);
}

}  // namespace priormap
