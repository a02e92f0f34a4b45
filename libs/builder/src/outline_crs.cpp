#include "outline_crs.hpp"

#include <set>

#include <priormap/builder/prior_crs.hpp>
#include <priormap/core/error.hpp>

#include "outline_groups.hpp"
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

std::optional<LonLatArea> area_of(const std::vector<OutlineGroup>& groups, const std::vector<InputCrs>& outlines) {
  std::optional<LonLatArea> all;
  for (const OutlineGroup& group : groups) {
    const InputCrs& input = outlines[group.file];
    if (!group.area) throw CrsError(input.file + ": its coordinates lie outside the domain of " + input.crs.name() + "; name the right CRS with --source-crs");
    all = all ? united(*all, *group.area) : *group.area;
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

  const SortedGroups groups = sort_out(outline_groups(input, outlines));
  const std::optional<LonLatArea> area = area_of(groups.main, outlines);
  const Crs prior = resolve_prior_crs(prior_options, with_heights, area, events);
  if (!ground_given) events.warn("the ground under the buildings is taken as 0 m; give --terrain or --ground-height");

  std::optional<HeightRaster> terrain_heights, surface_heights;
  if (terrain) terrain_heights = HeightRaster::open(terrain->file, terrain->override_crs, prior);
  if (surface) surface_heights = HeightRaster::open(surface->file, surface->override_crs, prior);
  const std::optional<double> constant_m = terrain ? outline_options.ground_height_m : std::optional(outline_options.ground_height_m.value_or(0));
  std::set<OutlineGroup::Cell> left_out;
  if (area && prior_options.bbox.empty())   // a box says what is wanted
    for (const OutlineGroup& stray : beyond_prior(groups.strays, *area, prior, [&](std::uint32_t file) { return outlines[file].file; }, events)) left_out.insert(stray.cells.begin(), stray.cells.end());
  std::vector<Transformer> prior_from_outlines;
  for (const InputCrs& outline : outlines) prior_from_outlines.push_back(transformer_to_prior(outline.crs.horizontal(), prior.horizontal(), area, outline.file));
  return {std::move(prior_from_outlines), prior, area, first.assumed_vertical,
          GroundModel(std::move(terrain_heights), constant_m, constant_to_prior(first, prior)), std::move(surface_heights), std::move(left_out)};
}

FootprintList without_strays(FootprintList footprints, const OutlineFrames& frames, Diagnostics& diagnostics) {
  if (frames.left_out.empty()) return footprints;
  FootprintList kept;
  for (const Footprint& footprint : footprints) {
    if (frames.left_out.contains(cell_of(footprint, frames.prior_from_outlines[footprint.file].source())))
      diagnostics.add(DiagnosticCode::far_from_the_rest, footprint.id, "lies far from the rest, outside the domain of the prior's CRS; left out");
    else
      kept.push_back(footprint);
  }
  return kept;
}

}  // namespace priormap
