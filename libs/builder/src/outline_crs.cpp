#include "outline_crs.hpp"

#include <algorithm>
#include <limits>

#include <priormap/builder/prior_crs.hpp>
#include <priormap/core/error.hpp>

namespace priormap {
namespace {

/// Heights that a raster leaves undeclared are those that the user names for the inputs.
std::optional<Crs> with_heights_named(const Crs& raster, const InputCrs& outlines) {
  if (raster.has_vertical() || !outlines.crs.vertical()) return std::nullopt;
  return raster.with_vertical(*outlines.crs.vertical());
}

struct NamedRaster {
  std::string file;
  std::optional<Crs> override_crs;
  Crs crs;
};

std::optional<NamedRaster> named_raster(const std::string& file, const InputCrs& outlines) {
  if (file.empty()) return std::nullopt;
  const std::optional<Crs> declared = read_raster_facts(file).crs;
  if (!declared) throw CrsError(file + ": has no coordinate reference system; write one into it, such as with gdal_edit.py -a_srs EPSG:25832+7837");
  const std::optional<Crs> named = with_heights_named(*declared, outlines);
  return NamedRaster{file, named, named.value_or(*declared)};
}

/// As an input of the prior's CRS: where the outlines lie, with heights as the raster has them.
InputCrs heights_of(const NamedRaster& raster, const InputCrs& outlines) {
  if (!raster.crs.has_vertical()) return {outlines.crs.horizontal(), "", raster.file};
  return {raster.crs.vertical() ? outlines.crs.horizontal().with_vertical(raster.crs) : raster.crs, "", raster.file};
}

Bounds2 bounds_of(const std::vector<Footprint>& footprints) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds2 bounds{infinity, infinity, -infinity, -infinity};
  for (const Footprint& footprint : footprints)
    for (const Ring2& ring : footprint.rings)
      for (const Eigen::Vector2d& p : ring)
        bounds = {std::min(bounds.min_x, p.x()), std::min(bounds.min_y, p.y()), std::max(bounds.max_x, p.x()), std::max(bounds.max_y, p.y())};
  return bounds;
}

LonLatArea lon_lat_area(const Bounds2& bounds, const Crs& crs) {
  const Transformer to_lon_lat(crs.horizontal(), Crs::parse("EPSG:4326"));
  const Eigen::Vector3d low = to_lon_lat.forward({bounds.min_x, bounds.min_y, 0}), high = to_lon_lat.forward({bounds.max_x, bounds.max_y, 0});
  return {low.x(), low.y(), high.x(), high.y()};
}

std::optional<Transformer> constant_to_prior(const InputCrs& outlines, const Crs& prior) {
  if (!prior.has_vertical() || !outlines.crs.vertical()) return std::nullopt;
  const Crs given = prior.horizontal().with_vertical(outlines.crs);
  return given.equivalent_to(prior) ? std::nullopt : std::optional(Transformer(given, prior));
}

}  // namespace

OutlineFrames resolve_outline_frames(const OutlineInput& input, const PriorOptions& prior_options, const OutlineOptions& outline_options, const Events& events) {
  const bool ground_given = !outline_options.terrain.empty() || outline_options.ground_height_m;
  if (!outline_options.heights_from.empty() && !ground_given)
    throw UsageError("--heights-from counts from the ground: give --terrain or --ground-height too");

  const InputCrs outlines = resolve_input_crs(prior_options, input.crs, input.files.front().path.string());
  const std::optional<NamedRaster> terrain = named_raster(outline_options.terrain, outlines), surface = named_raster(outline_options.heights_from, outlines);
  std::vector<InputCrs> with_heights;
  if (terrain) with_heights.push_back(heights_of(*terrain, outlines));
  else with_heights.push_back(outlines);
  if (surface) with_heights.push_back(heights_of(*surface, outlines));

  const Bounds2 bounds = bounds_of(input.footprints);
  const LonLatArea area = lon_lat_area(bounds, outlines.crs);
  const GeoPoint middle{0.5 * (area.south_deg + area.north_deg), 0.5 * (area.west_deg + area.east_deg), 0};
  const Crs prior = resolve_prior_crs(prior_options, with_heights, middle, events);
  if (!ground_given) events.warn("the ground under the buildings is taken as 0 m; give --terrain or --ground-height");

  std::optional<HeightRaster> terrain_heights, surface_heights;
  if (terrain) terrain_heights = HeightRaster::open(terrain->file, terrain->override_crs, prior);
  if (surface) surface_heights = HeightRaster::open(surface->file, surface->override_crs, prior);
  const std::optional<double> constant_m = terrain ? outline_options.ground_height_m : std::optional(outline_options.ground_height_m.value_or(0));
  return {Transformer(outlines.crs.horizontal(), prior.horizontal(), area), prior, outlines.assumed_vertical,
          GroundModel(std::move(terrain_heights), constant_m, constant_to_prior(outlines, prior)), std::move(surface_heights)};
}

}  // namespace priormap
