#include <priormap/builder/building_height.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace priormap {
namespace {

double tangent_deg(double angle_deg) { return std::tan(angle_deg * std::numbers::pi / 180); }

/// Where nothing but the shape is known.
double usual_rise_m(RoofShape shape, double run_m, double storey_m) {
  if (shape == RoofShape::dome) return run_m;
  if (shape == RoofShape::onion) return 1.5 * run_m;
  return std::min(run_m * tangent_deg(shape == RoofShape::skillion ? 10 : 30), storey_m);
}

/// `stated`: the source says so, so that a tall roof is believed.
struct Rise {
  double metres = 0;
  bool stated = false;
};

Rise roof_rise(const BuildingAttributes& attributes, double run_m, double storey_m) {
  if (attributes.roof_shape == RoofShape::flat || attributes.roof_shape == RoofShape::other) return {};
  if (attributes.roof_height_m) return {*attributes.roof_height_m, true};
  if (attributes.roof_angle_deg) return {run_m * tangent_deg(*attributes.roof_angle_deg), true};
  if (attributes.roof_levels && *attributes.roof_levels > 0) return {*attributes.roof_levels * storey_m, true};
  return {usual_rise_m(attributes.roof_shape, run_m, storey_m), false};
}

/// A flat roof with roof levels has full storeys in them.
double storeys_m(const BuildingAttributes& attributes, const Rise& rise, double storey_m) {
  const double in_roof = rise.metres > 0 ? 0 : attributes.roof_levels.value_or(0);
  return (*attributes.levels + in_roof) * storey_m + rise.metres;
}

/// Of a building whose height and levels are known: offices and halls have higher storeys than flats. Else the usual one.
double own_storey_m(const BuildingAttributes& attributes, const Rise& rise, std::optional<double> top_m, double usual_m) {
  const double storeys = attributes.levels.value_or(0) + (rise.metres > 0 ? 0 : attributes.roof_levels.value_or(0));
  return top_m && storeys > 0 && *top_m > rise.metres ? (*top_m - rise.metres) / storeys : usual_m;
}

}  // namespace

double height_sigma_m(HeightRule rule, const OutlineOptions& options) {
  switch (rule) {
    case HeightRule::levels: return options.levels_sigma_m;
    case HeightRule::fallback: return options.default_sigma_m;
    default: return options.height_sigma_m;
  }
}

std::string to_string(HeightRule rule) {
  switch (rule) {
    case HeightRule::tag: return "tag";
    case HeightRule::dsm: return "dsm";
    case HeightRule::levels: return "levels";
    case HeightRule::fallback: break;
  }
  return "default";
}

BuildingHeight building_height(const BuildingAttributes& attributes, std::optional<double> surface_m, double run_m, const OutlineOptions& options) {
  const double storey_m = options.storey_height_m;
  const Rise rise = roof_rise(attributes, run_m, storey_m);
  const std::optional<double> surface_top_m = surface_m ? std::optional(*surface_m + 0.3 * rise.metres) : std::nullopt;
  const double bottom_m = attributes.min_height_m.value_or(
      attributes.min_level.value_or(0) * own_storey_m(attributes, rise, attributes.height_m ? attributes.height_m : surface_top_m, storey_m));
  const double by_levels_m = attributes.levels ? storeys_m(attributes, rise, storey_m) : 0;

  BuildingHeight height;
  height.bottom_m = bottom_m;
  if (attributes.height_m) {
    height.rule = HeightRule::tag;
    height.top_m = *attributes.height_m;
    if (bottom_m >= height.top_m) height.bottom_m = 0;   // no walls could stand between them
  } else if (surface_m && *surface_m > bottom_m) {
    height.rule = HeightRule::dsm;
    height.top_m = *surface_top_m;
  } else if (by_levels_m > bottom_m) {
    height.rule = HeightRule::levels;
    height.top_m = by_levels_m;
  } else {
    height.top_m = bottom_m + options.default_height_m;
  }
  const double body_m = height.top_m - height.bottom_m;
  const double most_m = rise.stated ? body_m : height.rule == HeightRule::fallback ? 0.5 * body_m : 0.75 * body_m;
  height.eaves_m = height.top_m - std::min(rise.metres, most_m);
  return height;
}

}  // namespace priormap
