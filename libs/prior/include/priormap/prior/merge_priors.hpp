#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/core/option_field.hpp>
#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

struct MergeOptions {
  double min_distance_m = 0.1;
  std::vector<std::string> precedence;
  std::string assume_vertical;
  std::optional<double> tile_size_m;
  bool keep_guessed_roofs = false;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("min-distance", min_distance_m, {"leaves out points nearer than this to a source of higher precedence; 0: keeps all", "m", 0, 10});
    visit("precedence", precedence, {"kinds or ids of sources, the highest first (repeatable); those not named follow in the order of the arguments"});
    visit("assume-vertical", assume_vertical, {"vertical CRS of the result; takes undeclared heights as heights in it"});
    visit("tile-size", tile_size_m, {"edge of a tile; default: that of the first prior", "m", 1, 5000});
    visit("keep-guessed-roofs", keep_guessed_roofs, {"keeps points of buildings of guessed height where a surface raster contradicts them"});
  }
};

/// What became of the points. `kept` + the others = the points of the inputs.
struct MergeReport {
  PriorManifest manifest;
  std::uint64_t kept = 0;
  std::uint64_t duplicates = 0;         ///< the same place of the same feature of the same source, in several priors
  std::uint64_t under_models = 0;       ///< raster points inside the outline of a building model
  std::uint64_t contradicted = 0;       ///< of buildings of guessed height, by a surface raster
  std::uint64_t thinned = 0;            ///< nearer than the minimum distance to a source of higher precedence
};

/// "name    value" a line, what happened to no point left out.
std::string to_text(const MergeReport& report);

/// Joins priors into one. The rules are in docs/merging.md; none of them looks at tiles, threads or the order of points, so that
/// merging any split of a prior gives the prior.
/// @throws CrsError when heights undeclared and declared, or declared differently, meet without `assume_vertical`, or no exact
/// operation leads to the CRS of the first prior; FormatError for a damaged input; IoError; UsageError for an unknown name in
/// `precedence`.
MergeReport merge_priors(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& output,
                         const MergeOptions& options, Overwrite overwrite, int threads, const std::string& generator,
                         const Events& events = {});

}  // namespace priormap
