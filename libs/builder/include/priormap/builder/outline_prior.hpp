#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <priormap/builder/building_height.hpp>
#include <priormap/builder/outline_options.hpp>
#include <priormap/builder/prior_options.hpp>
#include <priormap/core/atomic_output.hpp>
#include <priormap/core/diagnostics.hpp>
#include <priormap/core/events.hpp>
#include <priormap/prior/prior_manifest.hpp>
#include <priormap/sources/footprint.hpp>

namespace priormap {

/// Each file once, by content, in an order that does not depend on how they were named. @throws IoError
struct HashedFile {
  std::filesystem::path path;
  std::string sha256;
};
std::vector<HashedFile> distinct_files(const std::vector<std::filesystem::path>& files);

/// Outlines as their reader gives them, and what the prior says of where they come from.
struct OutlineInput {
  FootprintList footprints;                     ///< `file` indexes `files`
  std::vector<HashedFile> files;                ///< each once
  std::vector<std::optional<Crs>> crs;          ///< of the footprints, file by file, by the files' word; none: they declare none
  std::string kind;                             ///< "osm", "footprints"
  std::string license, attribution;             ///< where the user names none
};

struct OutlineCounts {
  std::size_t outlines = 0;    ///< built, without those that parts replace
  std::size_t parts = 0;
  std::size_t replaced = 0;    ///< outlines that their parts fill
  std::array<std::size_t, num_height_rules> by_rule{};

  OutlineCounts& operator+=(const OutlineCounts& other);
};

struct OutlineReport {
  PriorManifest manifest;      ///< as written
  OutlineCounts counts;
  std::optional<SightCounts> sight;   ///< with --visible-from
  Diagnostics diagnostics;     ///< those given, and those met while building
};

/// From outlines to a prior: projects, puts rings in order, lets parts replace outlines, then, neighbourhood by neighbourhood, finds ground and heights, raises walls
/// and roofs, samples them and writes tiles. Some 250 bytes a building stay in memory, beside a bounded amount; the rest waits in temporary files.
/// The same bytes for any number of threads. Points are made from whole features and only then cut by --bbox.
/// @throws UsageError, CrsError, IoError, FormatError (no building in the input, none inside --bbox)
OutlineReport build_outline_prior(OutlineInput input, const PriorOptions& prior_options, const OutlineOptions& outline_options,
                                  const std::filesystem::path& output, Overwrite overwrite, const std::string& generator, Diagnostics diagnostics, int threads,
                                  const Events& events);

/// The report as a program prints it: counts, heights by rule, diagnostics.
std::string to_text(const OutlineReport& report);

}  // namespace priormap
