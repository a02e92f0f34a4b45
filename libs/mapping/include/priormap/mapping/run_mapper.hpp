#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/core/option_field.hpp>
#include <priormap/mapping/datasets.hpp>
#include <priormap/mapping/map_writer.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/prior_points.hpp>
#include <priormap/mapping/start.hpp>

namespace priormap {

/// One run of the mapper: what to map, against what, from where, how, and where to.
struct RunOptions {
  std::filesystem::path scans;
  DatasetOptions dataset;
  std::filesystem::path prior;            ///< empty: odometry
  PriorOptions prior_options;
  InitialPose initial;
  std::string preset = "default";
  std::uint64_t start = 0;                ///< scans to leave out at the beginning
  std::uint64_t limit = 0;                ///< scans to map at most; 0: all
  int jobs = 1;                           ///< stretches of the drive mapped at once; 1: in one piece
  StretchOptions stretches;
  bool resume = false;                    ///< goes on where an interrupted run stood
  double checkpoint_s = 5;                ///< between states kept for that; 0: none
  bool no_map = false;
  MapOptions map;
  std::filesystem::path output;
};

/// What the user sees at the end; the same figures stand in run.json.
struct RunSummary {
  std::size_t num_scans = 0;
  double length_m = 0;
  double mean_scan_ms = 0, median_scan_ms = 0, p95_scan_ms = 0;
  double total_s = 0;
  std::size_t num_motion_undone = 0;   ///< scans whose sweep was straightened by the times of its points
  std::uint64_t num_map_points = 0;
  std::uint64_t peak_memory_bytes = 0;
  std::size_t num_anchored = 0, num_weak = 0, num_dead_reckoned = 0, num_outside_prior = 0, num_lost = 0;
};

/// Maps the recording and writes the output directory, whole or not at all. A run that was killed goes on from its last checkpoint with `resume` and gives the same files (but for
/// times in run.json). @return none: with `resume` an output that is whole already is left as it is
/// @throws IoError, FormatError, CrsError, UsageError, each with one line for the user
std::optional<RunSummary> run_mapper(const RunOptions& options, int threads, Overwrite overwrite, const Events& events);

}  // namespace priormap
