#pragma once
#include <vector>

#include <priormap/builder/building_parts.hpp>
#include <priormap/builder/building_solid.hpp>
#include <priormap/builder/line_of_sight.hpp>
#include <priormap/prior/feature.hpp>
#include <priormap/prior/prior_writer.hpp>

#include "outline_crs.hpp"

namespace priormap {

/// Into the prior's CRS, rings in order. Takes the footprints' rings.
std::vector<ProjectedFootprint> project_footprints(std::vector<Footprint> footprints, const std::vector<Transformer>& prior_from_outlines, int threads,
                                                   Diagnostics& diagnostics);

/// One outline or part as it stands: its blocks, and what features.geojsonl says of it.
struct Building {
  std::vector<BuildingSolid> solids;   ///< empty: nothing stands there
  Feature feature;
  HeightRule rule = HeightRule::fallback;
  std::uint16_t file = 0;
  bool is_part = false;
};

/// Lets parts replace outlines, finds ground and heights, builds roofs. One Building a footprint, in the same order.
std::vector<Building> raise_buildings(const std::vector<ProjectedFootprint>& footprints, const PartAssignment& parts, const OutlineFrames& frames,
                                      const OutlineOptions& options, int threads, Diagnostics& diagnostics);

/// What is seen from --visible-from: buildings hide each other, one whose height is a guess only up to half of it. Nothing without that option.
std::optional<LineOfSight> line_of_sight(const std::vector<Building>& buildings, const OutlineFrames& frames, const SightOptions& options);

/// Samples all faces and hands the points to the writer.
/// @param sight  none: all points count as seen
/// @return by file, the points inside --bbox and those of them left out as never seen
std::vector<SightCounts> write_points(std::vector<Building> buildings, const LineOfSight* sight, const Crs& prior, const PriorOptions& prior_options,
                                      const OutlineOptions& outline_options, std::size_t num_files, PriorWriter& writer, int threads, const Events& events);

}  // namespace priormap
