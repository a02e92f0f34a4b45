#pragma once
#include <optional>
#include <string>
#include <vector>

#include <priormap/builder/prior_options.hpp>
#include <priormap/core/events.hpp>
#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/lon_lat_area.hpp>
#include <priormap/geodesy/transformer.hpp>

namespace priormap {

/// What the coordinates and heights of one input are, by its own word or the user's.
struct InputCrs {
  Crs crs;                        ///< with a vertical part where heights are declared or assumed
  std::string assumed_vertical;   ///< the vertical CRS taken on the user's word; empty: none
  std::string file;               ///< for messages
  std::string height_option = {};      ///< option that would bring declared heights, for messages; empty: none
};

/// `declared` as the file states it, overridden by --source-crs (with a warning where that contradicts it), its undeclared heights completed by --assume-vertical.
/// @throws CrsError when neither file nor options name a CRS.
InputCrs resolve_input_crs(const PriorOptions& options, const std::optional<Crs>& declared, const std::string& file, const Events& events);

/// The CRS of a prior made from `inputs` that lie in `area` (none: they hold nothing): --crs, or the UTM zone of its middle (the inputs' own zone where all have the
/// same one). Without a vertical part named, the inputs' common one is taken; heights that nobody declares stay undeclared, with one warning.
/// A --crs that is not meant for the middle's place is warned of, and lengths wrong by more than 1 % at a corner of the area. Where --bbox fits better, it counts.
/// @throws CrsError when the CRS is not projected in metres, or makes lengths wrong by more than 1 % in the middle of the area or of one of its edges, which the data
/// touch, or a named vertical CRS is asked from undeclared heights, or inputs disagree on their heights and none is asked for.
Crs resolve_prior_crs(const PriorOptions& options, const std::vector<InputCrs>& inputs, const std::optional<LonLatArea>& area, const Events& events);

/// From a CRS of the input `file` to the prior's, where the data lie in `area`. @throws CrsError naming the file: no exact operation is known there
Transformer transformer_to_prior(const Crs& input, const Crs& prior, const std::optional<LonLatArea>& area, const std::string& file);

/// Whether a prior's CRS makes lengths wrong by 1 % at most all over an area.
bool fits_lengths(const Crs& prior, const LonLatArea& area);

/// The vertical part of a prior's CRS as the manifest names it; nothing where heights are undeclared.
std::optional<std::string> vertical_name(const Crs& prior);

}  // namespace priormap
