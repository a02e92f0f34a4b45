#pragma once
#include <optional>
#include <set>
#include <vector>

#include <priormap/builder/ground_model.hpp>
#include <priormap/builder/outline_options.hpp>
#include <priormap/builder/outline_prior.hpp>
#include <priormap/builder/prior_options.hpp>
#include <priormap/geodesy/transformer.hpp>

#include "outline_groups.hpp"

namespace priormap {

/// Where outlines, ground and surface lie, and how they come into the prior's CRS. Copies are what a thread needs of its own.
struct OutlineFrames {
  std::vector<Transformer> prior_from_outlines;   ///< horizontal, by file
  Crs prior;
  std::optional<LonLatArea> area;                 ///< of the outlines but for strays; none where there is none
  std::string assumed_vertical;
  GroundModel ground;
  std::optional<HeightRaster> surface;
  std::set<OutlineGroup::Cell> left_out;          ///< where strays lie that the prior's CRS is not made for
};

/// Where at least nine tenths of the outlines lie together, they decide on the prior's CRS, and each group far from them is warned of: it is kept where that CRS makes
/// lengths wrong by 1 % at most, else left out.
/// @throws CrsError, IoError, FormatError, UsageError when a surface is given but no ground to count from
OutlineFrames resolve_outline_frames(const OutlineInput& input, const PriorOptions& prior_options, const OutlineOptions& outline_options, const Events& events);

/// Those that are not left out; the others are counted (708).
FootprintList without_strays(FootprintList footprints, const OutlineFrames& frames, Diagnostics& diagnostics);

}  // namespace priormap
