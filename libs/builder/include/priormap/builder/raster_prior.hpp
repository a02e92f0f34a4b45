#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <priormap/builder/prior_options.hpp>
#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

struct RasterPriorOptions {
  /// "terrain": bare ground, points are class ground. "surface": ground, roofs and trees that a raster alone cannot tell apart: unclassified.
  std::string kind = "surface";
  std::optional<double> sigma_m;
  double least_wall_m = 1.5;

  /// Bare ground has no walls.
  std::optional<double> walls() const { return kind == "surface" && least_wall_m > 0 ? std::optional(least_wall_m) : std::nullopt; }

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("sigma", sigma_m, {"standard deviation of a point; default: sqrt(s^2 + cell^2 / 12), s as the raster states (DTED) or 0.15", "m", 0.001, 65});
    visit("least-wall", least_wall_m, {"neighbouring cells of a surface of up to 2.5 m that differ by more, and by more than their width, are parted by a wall, whatever the --spacing; 0: no walls", "m", 0, 1000});
  }
  /// @throws UsageError for another kind
  void validate() const;
};

struct RasterReport {
  PriorManifest manifest;   ///< as written
  std::size_t rasters = 0;  ///< without files given twice
};

/// From rasters to a prior: reads block by block, brings cells into the prior's CRS, cuts by --bbox and writes tiles.
/// Where rasters overlap the finer one has the word (of equal cells the one whose content hash is lower): a point is left out where a preferred
/// raster has a height. The result does not depend on the order of the files or the number of threads.
/// @throws UsageError, CrsError, IoError, FormatError (no raster, no height, none inside --bbox)
RasterReport build_raster_prior(const std::vector<std::filesystem::path>& inputs, const PriorOptions& prior_options, const RasterPriorOptions& raster_options,
                                const std::filesystem::path& output, Overwrite overwrite, const std::string& generator, int threads, const Events& events);

/// The report as a program prints it.
std::string to_text(const RasterReport& report);

}  // namespace priormap
