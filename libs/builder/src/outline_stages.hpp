#pragma once
#include <optional>
#include <string>
#include <vector>

#include <priormap/builder/building_parts.hpp>
#include <priormap/builder/line_of_sight.hpp>
#include <priormap/builder/outline_prior.hpp>
#include <priormap/prior/prior_writer.hpp>

#include "building_raiser.hpp"

namespace priormap {

/// Into the prior's CRS, rings in order, each outline once (707).
ProjectedFootprints project_footprints(const FootprintList& footprints, const std::vector<Transformer>& prior_from_outlines, int threads, Diagnostics& diagnostics);

/// What is seen from --visible-from: buildings hide each other, one whose height is a guess only up to half of it. Nothing without that option.
std::optional<LineOfSight> line_of_sight(const ProjectedFootprints& footprints, const PartAssignment& parts, const OutlineFrames& frames, const OutlineOptions& options);

/// Of the buildings of one file.
struct WrittenBuildings {
  OutlineCounts counts;
  SightCounts points;   ///< inside --bbox, and those of them left out as never seen
  std::size_t with_surface = 0, under_ground = 0;   ///< buildings that a surface model was asked for, and those of them where it lies under the ground

  WrittenBuildings& operator+=(const WrittenBuildings& other) {
    counts += other.counts;
    points += other.points;
    with_surface += other.with_surface;
    under_ground += other.under_ground;
    return *this;
  }
};

/// Raises the buildings neighbourhood by neighbourhood, samples their faces and hands the points to the writer.
/// @param source_ids  by file; the result too
/// @param sight       none: all points count as seen
std::vector<WrittenBuildings> write_buildings(const ProjectedFootprints& footprints, const PartAssignment& parts, const OutlineFrames& frames,
                                              const std::vector<std::string>& source_ids, const LineOfSight* sight, const PriorOptions& prior_options,
                                              const OutlineOptions& outline_options, PriorWriter& writer, Diagnostics& diagnostics, int threads, const Events& events);

}  // namespace priormap
