#include <priormap/builder/prior_crs.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/option_crs.hpp>
#include <priormap/geodesy/transformer.hpp>

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

/// Of the inputs' middle and that of --bbox, which may take a corner of them, the one that fits the CRS better.
GeoPoint best_place(const Crs& crs, const PriorOptions& options, const GeoPoint& middle) {
  if (options.bbox.empty()) return middle;
  const std::vector<double>& b = options.bbox;
  const Transformer to_lon_lat(horizontal_option_crs("--bbox-crs", options.bbox_crs), Crs::parse("EPSG:4326"));
  const Eigen::Vector3d p = to_lon_lat.forward({0.5 * (b[0] + b[2]), 0.5 * (b[1] + b[3]), 0});
  if (!p.allFinite()) return middle;
  const GeoPoint middle_of_box{p.y(), p.x(), 0};
  const auto misfit = [&](const GeoPoint& place) { return std::pair(crs.length_distortion(place) > most_distortion, degrees_outside(crs, place)); };
  return misfit(middle_of_box) < misfit(middle) ? middle_of_box : middle;
}

/// A CRS that is asked for where it does not belong is a slip: mostly the wrong zone. Neighbouring zones are in use side by side, so
/// that is said and done as asked; where a metre of the grid is no metre any more, spacing and sigmas would be wrong.
void check_fits(const Crs& asked, const GeoPoint& place, const Events& events) {
  std::ostringstream where;
  where << std::fixed << std::setprecision(3) << "longitude " << place.lon_deg << ", latitude " << place.lat_deg;
  const std::string name = "--crs " + asked.name() + " (" + asked.horizontal().human_name() + ")";
  if (const double distortion = asked.length_distortion(place); !(distortion <= most_distortion)) {
    std::ostringstream how;
    if (std::isfinite(distortion)) how << "makes lengths wrong by " << std::setprecision(2) << 100 * distortion << " %"; else how << "does not reach";
    throw CrsError(name + " " + how.str() + " where the data lie (" + where.str() + ")" + fitting_zone(asked, place));
  }
  if (degrees_outside(asked, place) <= border_deg) return;
  const std::optional<LonLatArea> area = asked.area_of_use();
  events.warn(name + " is meant for longitudes " + degrees_text(area->west_deg, area->east_deg) + " and latitudes " + degrees_text(area->south_deg, area->north_deg) +
              ", the data lie at " + where.str() + fitting_zone(asked, place));
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

Crs resolve_prior_crs(const PriorOptions& options, const std::vector<InputCrs>& inputs, const std::optional<GeoPoint>& middle, const Events& events) {
  const Crs asked = options.crs.empty() ? default_horizontal(inputs, middle.value_or(GeoPoint{})) : option_crs("--crs", options.crs);
  check_projected_in_metres(asked, middle);
  if (!options.crs.empty() && middle) check_fits(asked, best_place(asked, options, *middle), events);
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

std::optional<std::string> vertical_name(const Crs& prior) {
  if (!prior.has_vertical()) return std::nullopt;
  const auto vertical = prior.vertical();
  return vertical ? vertical->name() : prior.name();
}

}  // namespace priormap
