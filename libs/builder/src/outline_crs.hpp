#pragma once
#include <optional>
#include <vector>

#include <priormap/builder/ground_model.hpp>
#include <priormap/builder/outline_options.hpp>
#include <priormap/builder/outline_prior.hpp>
#include <priormap/builder/prior_options.hpp>
#include <priormap/geodesy/transformer.hpp>

namespace priormap {

/// Where outlines, ground and surface lie, and how they come into the prior's CRS. Copies are what a thread needs of its own.
struct OutlineFrames {
  std::vector<Transformer> prior_from_outlines;   ///< horizontal, by file
  Crs prior;
  std::optional<LonLatArea> area;                 ///< of all outlines; none where there is none
  std::string assumed_vertical;
  GroundModel ground;
  std::optional<HeightRaster> surface;
};

/// @throws CrsError, IoError, FormatError, UsageError when a surface is given but no ground to count from
OutlineFrames resolve_outline_frames(const OutlineInput& input, const PriorOptions& prior_options, const OutlineOptions& outline_options, const Events& events);

}  // namespace priormap
