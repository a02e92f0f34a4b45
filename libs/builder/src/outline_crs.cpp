#include "outline_crs.hpp"

#include <algorithm>
#include <limits>

#include <priormap/builder/prior_crs.hpp>
#include <priormap/core/error.hpp>

#include "raster_faults.hpp"

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

std::optional<NamedRaster> named_raster(const std::string& file, const InputCrs& outlines, const Events& events) {
  if (file.empty()) return std::nullopt;
  const RasterFacts facts = read_raster_facts(file);
  warn_of_unknown_unit(file, facts, events);
  const std::optional<Crs>& declared = facts.crs;
  if (!declared) throw CrsError(file + ": has no coordinate reference system; write one into it, such as with gdal_edit.py -a_srs EPSG:25832+7837");
  const std::optional<Crs> named = with_heights_named(*declared, outlines);
  return NamedRaster{file, named, named.value_or(*declared)};
}

/// As an input of the prior's CRS: where the outlines lie, with heights as the raster has them.
InputCrs heights_of(const NamedRaster& raster, const InputCrs& outlines) {
  if (!raster.crs.has_vertical()) return {outlines.crs.horizontal(), "", raster.file};
  return {raster.crs.vertical() ? outlines.crs.horizontal().with_vertical(raster.crs) : raster.crs, "", raster.file};
}

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
  return std::max(b.max_x - b.min_x, b.max_y - b.min_y) * unit_m > longest_m;
}

/// Of the footprints of each file, in its own CRS; without extent for a file without any.
std::vector<PlaceBounds> bounds_by_file(const OutlineInput& input, const std::vector<InputCrs>& outlines) {
  std::vector<PlaceBounds> bounds(input.files.size());
  for (const Footprint& footprint : input.footprints) {
    PlaceBounds own;
    for (const Ring2& ring : footprint.rings)
      for (const Eigen::Vector2d& p : ring) own.extend(p);
    const Crs& crs = outlines[footprint.file].crs;
    if (!is_implausible(own.of(crs), crs)) bounds[footprint.file].extend(own);
  }
  return bounds;
}

std::optional<LonLatArea> lon_lat_area(const std::vector<PlaceBounds>& bounds, const std::vector<InputCrs>& outlines) {
  std::optional<LonLatArea> all;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const Bounds2 own = bounds[i].of(outlines[i].crs);
    if (own.empty()) continue;
    const std::optional<LonLatArea> area = priormap::lon_lat_area(own, outlines[i].crs);
    if (!area) throw CrsError(outlines[i].file + ": its coordinates lie outside the domain of " + outlines[i].crs.name() + "; name the right CRS with --source-crs");
    all = all ? united(*all, *area) : *area;
  }
  return all;
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

  std::vector<InputCrs> outlines;
  for (std::size_t i = 0; i < input.files.size(); ++i) outlines.push_back(resolve_input_crs(prior_options, input.crs[i], input.files[i].path.string(), events));
  const InputCrs& first = outlines.front();
  const std::optional<NamedRaster> terrain = named_raster(outline_options.terrain, first, events), surface = named_raster(outline_options.heights_from, first, events);
  std::vector<InputCrs> with_heights;
  for (const InputCrs& outline : outlines) with_heights.push_back(terrain ? heights_of(*terrain, outline) : InputCrs{outline.crs, outline.assumed_vertical, outline.file, "--terrain"});
  if (surface) with_heights.push_back(heights_of(*surface, first));

  const std::optional<LonLatArea> area = lon_lat_area(bounds_by_file(input, outlines), outlines);
  const Crs prior = resolve_prior_crs(prior_options, with_heights, area, events);
  if (!ground_given) events.warn("the ground under the buildings is taken as 0 m; give --terrain or --ground-height");

  std::optional<HeightRaster> terrain_heights, surface_heights;
  if (terrain) terrain_heights = HeightRaster::open(terrain->file, terrain->override_crs, prior);
  if (surface) surface_heights = HeightRaster::open(surface->file, surface->override_crs, prior);
  const std::optional<double> constant_m = terrain ? outline_options.ground_height_m : std::optional(outline_options.ground_height_m.value_or(0));
  std::vector<Transformer> prior_from_outlines;
  for (const InputCrs& outline : outlines) prior_from_outlines.emplace_back(outline.crs.horizontal(), prior.horizontal(), area);
  return {std::move(prior_from_outlines), prior, area, first.assumed_vertical,
          GroundModel(std::move(terrain_heights), constant_m, constant_to_prior(first, prior)), std::move(surface_heights)};
}

}  // namespace priormap
