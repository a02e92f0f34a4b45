#include <priormap/builder/prior_crs.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <span>
#include <sstream>
#include <utility>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/option_crs.hpp>
#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {
namespace {

bool is_utm_zone(const Crs& crs) { return crs.is_projected() && crs.human_name().find("UTM zone") != std::string::npos; }

/// The UTM zone that all inputs are in already, so that nothing is moved without need.
std::optional<Crs> common_utm_zone(const std::vector<InputCrs>& inputs) {
  if (inputs.empty()) return std::nullopt;
  const Crs first = inputs[0].crs.horizontal();
  const bool all_same = std::all_of(inputs.begin(), inputs.end(), [&](const InputCrs& input) { return input.crs.horizontal().equivalent_to(first); });
  if (!all_same || !is_utm_zone(first) || first.horizontal_unit_m() != 1) return std::nullopt;
  return first;
}

/// ETRS89 and its national realisations: data in them belong into EPSG:258zz.
bool is_etrs89(const Crs& crs) {
  const std::string base = crs.horizontal().geographic_base().human_name();
  return base.find("ETRS89") != std::string::npos || base.find("ETRF") != std::string::npos || base.find("SWEREF99") != std::string::npos ||
         base.find("RGF93") != std::string::npos;
}

Crs default_horizontal(const std::vector<InputCrs>& inputs, const GeoPoint& middle) {
  if (const auto own = common_utm_zone(inputs)) return *own;
  const bool etrs89 = !inputs.empty() && std::all_of(inputs.begin(), inputs.end(), [](const InputCrs& input) { return is_etrs89(input.crs); });
  return Crs::utm_zone(middle.lon_deg, middle.lat_deg, etrs89);
}

std::string degrees_text(double west, double east) {
  std::ostringstream text;
  text << std::setprecision(4) << west << " to " << east;
  return text.str();
}

/// The UTM zone of a place; nothing where none reaches.
std::optional<std::string> zone_at(const Crs& asked, const GeoPoint& place) {
  constexpr double southernmost_deg = -80, northernmost_deg = 84;
  if (place.lat_deg < southernmost_deg || place.lat_deg > northernmost_deg) return std::nullopt;
  return Crs::utm_zone(place.lon_deg, place.lat_deg, is_etrs89(asked)).name();
}

/// "; EPSG:25832 fits there", where a zone does.
std::string fitting_zone(const Crs& asked, const GeoPoint& place) {
  const std::optional<std::string> zone = zone_at(asked, place);
  return zone ? "; " + *zone + " fits there" : "";
}

/// @param middle  of the data
void check_projected_in_metres(const Crs& crs, const std::optional<GeoPoint>& middle) {
  const std::optional<std::string> zone = middle ? zone_at(crs, *middle) : std::nullopt;
  const std::string needed = "; a prior needs a projected CRS in metres, " + (zone ? "here the UTM zone " + *zone : "such as a UTM zone (EPSG:25832)");
  if (!crs.is_projected()) throw UsageError("--crs " + crs.name() + " is not projected" + needed);
  if (crs.horizontal_unit_m() != 1 || crs.vertical_unit_m() != 1) throw UsageError("--crs " + crs.name() + " is not in metres" + needed);
  if (crs.heights_point_down()) throw UsageError("--crs " + crs.name() + " counts depths; a prior needs heights");
}

constexpr double most_distortion = 0.01, border_deg = 0.25;

double degrees_outside(const Crs& crs, const GeoPoint& place) {
  const std::optional<LonLatArea> area = crs.area_of_use();
  return area ? area->degrees_outside(place) : 0;
}

std::string text_of(const GeoPoint& place) {
  return (std::ostringstream() << std::fixed << std::setprecision(3) << "longitude " << place.lon_deg << ", latitude " << place.lat_deg).str();
}

/// How wrong lengths on the grid are at a place.
struct Distortion {
  double relative = 0;
  GeoPoint place;

  bool is_too_much() const { return !(relative <= most_distortion); }
  std::string text() const {
    std::ostringstream text;
    if (std::isfinite(relative)) text << "makes lengths wrong by " << std::setprecision(2) << 100 * relative << " %"; else text << "does not reach";
    return text.str();
  }
};

/// Where they are wrong the most.
struct AreaDistortion {
  Distortion middle;
  Distortion at_edges;     ///< in the middle of one: each is touched by data
  Distortion at_corners;   ///< where none need to lie
  const Distortion& at_data() const { return middle.is_too_much() || middle.relative >= at_edges.relative ? middle : at_edges; }
};

AreaDistortion distortion_over(const Crs& crs, const LonLatArea& area) {
  std::vector<GeoPoint> places{area.middle()};
  std::ranges::copy(area.edge_middles(), std::back_inserter(places));
  std::ranges::copy(area.corners(), std::back_inserter(places));
  const std::vector<double> distortions = crs.length_distortions(places);
  const auto worst = [&](std::size_t first, std::size_t count) {
    const auto at = std::ranges::max_element(std::span(distortions).subspan(first, count)) - std::span(distortions).begin();
    return Distortion{distortions[static_cast<std::size_t>(at)], places[static_cast<std::size_t>(at)]};
  };
  return {worst(0, 1), worst(1, 4), worst(5, 4)};
}

/// Of the inputs' area and that of --bbox, which may take a corner of them, the one that fits the CRS better.
LonLatArea best_area(const Crs& crs, const PriorOptions& options, const LonLatArea& area) {
  if (options.bbox.empty()) return area;
  const std::optional<LonLatArea> box = lon_lat_area(options.box(), horizontal_option_crs("--bbox-crs", options.bbox_crs));
  if (!box) return area;
  const auto misfit = [&](const LonLatArea& a) { return std::pair(distortion_over(crs, a).at_data().is_too_much(), degrees_outside(crs, a.middle())); };
  return misfit(*box) < misfit(area) ? *box : area;
}

std::string described(const Crs& crs, const PriorOptions& options) {
  return (options.crs.empty() ? "" : "--crs ") + crs.name() + " (" + crs.horizontal().human_name() + ")";
}

/// Where a metre of the grid is no metre any more, spacing and sigmas would be wrong.
void check_lengths(const Crs& crs, const PriorOptions& options, const LonLatArea& area, const Events& events) {
  constexpr const char* for_the_whole = "; --bbox keeps a part of the data, --crs names a CRS made for all of their area";
  const AreaDistortion over = distortion_over(crs, area);
  if (const Distortion& worst = over.at_data(); worst.is_too_much())
    throw CrsError(described(crs, options) + " " + worst.text() + " where the data lie (" + text_of(worst.place) + ")" +
                   (over.middle.is_too_much() ? fitting_zone(crs, worst.place) : for_the_whole));
  if (over.at_corners.is_too_much())
    events.warn(described(crs, options) + " " + over.at_corners.text() + " at a corner of the data's extent (" + text_of(over.at_corners.place) + ")" + for_the_whole);
}

/// A CRS that is asked for where it does not belong is a slip: mostly the wrong zone. Neighbouring zones are in use side by side, so that is said and done as asked.
void check_use(const Crs& asked, const PriorOptions& options, const GeoPoint& place, const Events& events) {
  if (degrees_outside(asked, place) <= border_deg) return;
  const std::optional<LonLatArea> use = asked.area_of_use();
  events.warn(described(asked, options) + " is meant for longitudes " + degrees_text(use->west_deg, use->east_deg) + " and latitudes " + degrees_text(use->south_deg, use->north_deg) +
              ", the data lie at " + text_of(place) + fitting_zone(asked, place));
}

/// For heights that are undeclared.
std::string remedy(const InputCrs& input, const std::string& vertical) {
  const std::string better = input.height_option.empty() ? "" : "give " + input.height_option + " with declared heights, or ";
  return "; " + better + "say --assume-vertical " + vertical + " if they are in it";
}

/// Ellipsoidal heights belong to a horizontal CRS and cannot be assumed by themselves.
std::string remedy_for(const InputCrs& input, const Crs& asked) {
  const auto vertical = asked.vertical();
  return vertical ? remedy(input, vertical->name()) : "; declare them with --source-crs";
}

/// The vertical part that heights are declared in by all inputs alike; nothing where none declares any.
std::optional<Crs> common_vertical(const std::vector<InputCrs>& inputs) {
  std::optional<Crs> common;
  for (const InputCrs& input : inputs) {
    if (!input.crs.has_vertical()) continue;
    const auto vertical = input.crs.vertical();
    if (!vertical)
      throw CrsError(input.file + ": heights are ellipsoidal (" + input.crs.name() + "); name the prior's vertical CRS, such as --crs EPSG:32632+5773");
    if (common && !common->equivalent_to(*vertical))
      throw CrsError(input.file + ": heights are in " + vertical->name() + ", others in " + common->name() + "; name the prior's vertical CRS with --crs H+V");
    common = vertical;
  }
  if (!common) return std::nullopt;
  for (const InputCrs& input : inputs)
    if (!input.crs.has_vertical()) throw CrsError(input.file + ": heights are undeclared, those of other inputs are in " + common->name() + remedy(input, common->name()));
  return common;
}

Crs with_heights_in_metres(const Crs& horizontal, const Crs& vertical) {
  const Crs crs = horizontal.with_vertical(vertical);
  if (crs.vertical_unit_m() != 1 || crs.heights_point_down())
    throw CrsError("the inputs' heights (" + vertical.name() + ") are not heights in metres; name the prior's vertical CRS, such as --crs " + horizontal.name() + "+5703");
  return crs;
}

/// Completing what a file says is no contradiction.
bool contradicts(const Crs& named, const Crs& declared) {
  if (named.is_vertical()) return false;   // refused below
  if (!named.horizontal().equivalent_to(declared.horizontal())) return true;
  return declared.has_vertical() && (!named.has_vertical() || !named.equivalent_to(declared));
}

}  // namespace

InputCrs resolve_input_crs(const PriorOptions& options, const std::optional<Crs>& declared, const std::string& file, const Events& events) {
  std::optional<Crs> crs = declared;
  if (!options.source_crs.empty()) {
    crs = option_crs("--source-crs", options.source_crs);
    if (crs->is_vertical()) throw UsageError("--source-crs " + crs->name() + " has heights only; a horizontal CRS is needed too, such as EPSG:25832+7837");
    if (declared && contradicts(*crs, *declared))
      events.warn(file + ": says that it is in " + declared->name() + "; read as " + crs->name() + " by --source-crs");
  }
  if (!crs) throw CrsError(file + ": has no coordinate reference system; name it with --source-crs, such as EPSG:25832+7837");
  if (crs->is_vertical()) throw CrsError(file + ": " + crs->name() + " has heights only; a horizontal CRS is needed too, such as EPSG:25832+7837");
  if (options.assume_vertical.empty() || crs->has_vertical()) return {*crs, "", file};
  const Crs assumed = vertical_option_crs("--assume-vertical", options.assume_vertical);
  return {crs->with_vertical(assumed), assumed.name(), file};
}

Crs resolve_prior_crs(const PriorOptions& options, const std::vector<InputCrs>& inputs, const std::optional<LonLatArea>& area, const Events& events) {
  const std::optional<GeoPoint> middle = area ? std::optional(area->middle()) : std::nullopt;
  const Crs asked = options.crs.empty() ? default_horizontal(inputs, middle.value_or(GeoPoint{})) : option_crs("--crs", options.crs);
  check_projected_in_metres(asked, middle);
  if (area) {
    const LonLatArea best = best_area(asked, options, *area);
    check_lengths(asked, options, best, events);
    if (!options.crs.empty()) check_use(asked, options, best.middle(), events);
  }
  if (asked.has_vertical()) {
    for (const InputCrs& input : inputs)
      if (!input.crs.has_vertical()) throw CrsError(input.file + ": heights are undeclared, but the prior is asked for in " + asked.name() + remedy_for(input, asked));
    return asked;
  }
  if (const auto vertical = common_vertical(inputs)) return with_heights_in_metres(asked, *vertical);
  if (!inputs.empty()) {
    const std::string better = inputs[0].height_option.empty() ? "" : "give " + inputs[0].height_option + " with declared heights, or ";
    const std::string in_metres = inputs[0].crs.horizontal_unit_m() != 1 ? ", taken as metres though x and y are not" : "";
    events.warn(inputs[0].file + ": heights are undeclared and stay as they are (\"vertical\": null)" + in_metres + "; " + better + "--assume-vertical V, such as EPSG:7837, says in which vertical CRS they are");
  }
  return asked;
}

Transformer transformer_to_prior(const Crs& input, const Crs& prior, const std::optional<LonLatArea>& area, const std::string& file) {
  try {
    return Transformer(input, prior, area);
  } catch (const CrsError& error) {
    throw CrsError(file + ": " + error.what() + "; else name with --crs a CRS that is made for where the data lie");
  }
}

bool fits_lengths(const Crs& prior, const LonLatArea& area) {
  const AreaDistortion over = distortion_over(prior, area);
  return !over.at_data().is_too_much() && !over.at_corners.is_too_much();
}

std::optional<std::string> vertical_name(const Crs& prior) {
  if (!prior.has_vertical()) return std::nullopt;
  const auto vertical = prior.vertical();
  return vertical ? vertical->name() : prior.name();
}

}  // namespace priormap
