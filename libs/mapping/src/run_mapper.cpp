#include <priormap/mapping/run_mapper.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <future>
#include <iterator>
#include <optional>
#include <sstream>

#include <priormap/core/error.hpp>
#include <priormap/core/process.hpp>
#include <priormap/mapping/mapper.hpp>
#include <priormap/mapping/motion.hpp>
#include <priormap/mapping/read_ahead.hpp>

#include "checkpoints.hpp"
#include "confidence.hpp"
#include "datasets/file_numbers.hpp"
#include "run_inputs.hpp"
#include "run_report.hpp"
#include "trajectory_writer.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  /// Seconds since the last lap.
  double lap() {
    const double now = seconds(), since = now - last_;
    last_ = now;
    return since;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double last_ = 0;
};

ScanRange range_of(const ScanSource& source, const RunOptions& options) {
  if (options.start >= source.size())
    throw UsageError("--start " + std::to_string(options.start) + " is beyond the end: there are " + std::to_string(source.size()) + " scans (counted from 0)");
  const std::size_t available = source.size() - options.start;
  return {options.start, options.start + (options.limit == 0 ? available : std::min<std::size_t>(options.limit, available))};
}

Scan first_scan(const ScanSource& source, std::size_t index) {
  Scan scan = source.read(index);
  if (scan.points.empty())
    throw FormatError(source.file(index), "the scan holds no points" + std::string(scan.num_skipped ? " of use (finite, within 10 km of the sensor)" : "") + "; begin at a later one with --start");
  return scan;
}

/// What the online pass leaves, and what is kept in its checkpoints.
struct OnlinePass {
  Mapper mapper;
  std::vector<double> step_s;   // that each scan took
  void exchange(StateArchive& archive) { archive(mapper, step_s); }
};

/// The online pass: every scan in order, from where `pass` stands.
void map_scans(OnlinePass& pass, const ScanSource& source, ScanRange range, const RunOptions& options, Checkpoints& checkpoints, const Events& events) {
  const auto went_on = [&] {
    events.advance("mapping", static_cast<double>(pass.step_s.size()) / static_cast<double>(range.last - range.first));
    checkpoints.offer([&](StateArchive& archive) { pass.exchange(archive); });
  };
  if (options.jobs > 1) {
    pass.mapper.step_stretches(source, range.first, range.last, options.stretches, options.jobs, [&](std::span<const MappedScan> placed) {
      for (const MappedScan& scan : placed) pass.step_s.push_back(scan.step_s);
      went_on();
    });
    return;
  }
  ReadAhead<ReadyScan> scans([&source, prepare = pass.mapper.preparation()](std::size_t index) { return prepare(source.read(index)); }, range.first + pass.step_s.size(), range.last);
  Stopwatch watch;
  while (auto scan = scans.next()) {
    pass.mapper.step(std::move(*scan));
    pass.step_s.push_back(watch.lap());
    went_on();
  }
}

void resume(OnlinePass& pass, const Checkpoints& checkpoints, const fs::path& checkpoint_file, ScanRange range, const Events& events) {
  if (checkpoints.restore([&](StateArchive& archive) { pass.exchange(archive); }))
    events.inform("going on after " + std::to_string(pass.step_s.size()) + " of " + std::to_string(range.last - range.first) + " scans");
  else if (fs::exists(checkpoint_file))
    events.warn(checkpoint_file.string() + ": the checkpoint is damaged and cannot be gone on from; beginning anew with the first scan");
  else
    events.inform("no checkpoint of this output: beginning with the first scan");
}

/// Without --resume a checkpoint is not looked at, but lost only when one of this run takes its place.
void tell_of_checkpoint(const ResumableDirectory& output, const Events& events) {
  if (output.checkpoint()) events.inform("beginning with the first scan: the checkpoint of an interrupted run, from which --resume goes on, is replaced by the first one of this run");
}

/// What an output that is whole needs of a run that would go on with it: nothing, but for what a kill while it was put in place left beside it.
void leave_as_it_is(ResumableDirectory& output, const fs::path& directory, const std::string& identity, const Events& events) {
  const std::string differs = difference(identity_in(directory / "run.json"), identity);
  if (!differs.empty()) throw UsageError("--resume: " + directory.string() + " is whole already, and of another run: " + differs + "; leave out --resume, and give --overwrite or another output");
  output.discard_checkpoint();
  events.inform(directory.string() + " is whole already: there is nothing to resume");
}

void warn_of_empty_scans(const std::vector<MappedScan>& scans, const ScanSource& source, const Events& events) {
  const auto is_empty = [](const MappedScan& scan) { return scan.num_points == 0; };
  const auto first = std::find_if(scans.begin(), scans.end(), is_empty);
  if (first == scans.end()) return;
  events.warn("scans that hold no points of use (finite, within 10 km of the sensor): " + std::to_string(std::count_if(first, scans.end(), is_empty)) + ", the first is " + source.file(first->index).string() +
              "; the motion was carried on there");
}

/// They leave a gap in the drive, and shift what is counted by the order of the files.
void warn_of_missing_scans(const ScanSource& source, ScanRange range, const Events& events) {
  std::vector<fs::path> files;
  for (std::size_t i = range.first; i < range.last; ++i) files.push_back(source.file(i));
  const MissingFiles missing = missing_files(files);
  if (missing.count == 0) return;
  events.warn("scans missing between " + files.front().string() + " and " + files.back().filename().string() + ": " + std::to_string(missing.count) + ", the first is " + missing.first +
              "; stamps: " + source.info().stamps);
}

void warn_of_idle_times(const RunOptions& options, const Events& events) {
  const std::string& asked = options.dataset.point_times;
  if (options.preset == "paper" && !asked.empty() && asked != "none") events.warn("--point-times has no effect with --preset paper, which takes sweeps as they are");
}

void warn_of_idle_stretches(const RunOptions& options, const Events& events) {
  const StretchOptions usual;
  if (options.jobs == 1 && (options.stretches.scans != usual.scans || options.stretches.overlap != usual.overlap))
    events.warn("--stretch and --stretch-overlap have no effect without --jobs above 1: the drive is mapped in one piece");
}

PriorManifest map_manifest(const RunOptions& options, const PriorPoints* prior, const Start& start, const ScanSource& source, ScanRange range) {
  PriorManifest manifest;
  if (start.crs) {
    manifest.crs = start.crs->name();
    if (start.crs->has_vertical()) manifest.vertical = start.crs->vertical()->name();
  }
  manifest.generator = generator();
  PriorSource scanned;
  scanned.id = "scans";
  scanned.kind = "mapper";
  scanned.file_name = options.scans.filename().string();
  scanned.sha256 = listing_hash(source, range);
  scanned.crs = manifest.crs;
  scanned.facts = {{"scans", std::to_string(range.last - range.first)}, {"dataset", source.info().dataset}, {"preset", options.preset}};
  if (prior) {
    scanned.facts.emplace_back("prior", prior->identity().name);
    for (const auto& text : prior->identity().attributions) scanned.attribution += (scanned.attribution.empty() ? "placed against: " : "; ") + text;
  }
  manifest.sources = {scanned};
  return manifest;
}

double quantile(std::vector<double> values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Scans of which nobody knows where they were taken do not belong into a map.
std::vector<MappedScan> placed(const std::vector<MappedScan>& scans) {
  std::vector<MappedScan> kept;
  std::copy_if(scans.begin(), scans.end(), std::back_inserter(kept), [](const MappedScan& scan) { return scan.verdict != Verdict::lost; });
  return kept;
}

std::size_t count(const std::vector<MappedScan>& scans, Verdict verdict) {
  return static_cast<std::size_t>(std::count_if(scans.begin(), scans.end(), [&](const MappedScan& s) { return s.verdict == verdict; }));
}

void warn_of_bad_start(const std::vector<MappedScan>& scans, const PriorPoints& prior, const Events& events) {
  const auto num_contradicted = std::ranges::count_if(scans, [](const MappedScan& scan) { return scan.contradicted; });
  if (num_contradicted > 0) {
    events.warn("around " + std::to_string(num_contradicted) + " of " + std::to_string(scans.size()) + " scans the walls of " + prior.identity().name +
                " are not where the scans see walls, or the drive was not found again beyond a gap in the recording: check the initial pose (6 m and 12 degrees are found; 50 m and any direction where the prior holds a surface model as well), and that prior and scans are of one place");
  } else if (count(scans, Verdict::anchored) + count(scans, Verdict::weak) == 0) {
    events.warn("no scan is anchored: " + prior.identity().name + " was not matched anywhere; check the initial pose");
  } else if (const MappedScan& first = scans.front(); first.prior && !first.prior->accepted) {
    events.warn("the first scan does not match the prior (" + std::to_string(first.prior->num_inliers) + " of " + std::to_string(first.prior->num_correspondences) +
                " points near it fit): check the initial pose");
  }
}

/// Of heights that were doubted because prior and start disagree.
void warn_of_height_gap(const std::vector<MappedScan>& scans, const Start& start, const PriorPoints& prior, const Events& events) {
  const MappedScan& first = scans.front();
  const double gap_m = first.T_map_sensor.translation().z() - start.T_map_sensor.translation().z();
  const Eigen::Vector3d up = first.T_map_sensor.linear().row(2);
  const bool in_prior = first.verdict == Verdict::anchored || first.verdict == Verdict::weak;
  const bool doubted = up.dot(first.covariance.bottomRightCorner<3, 3>() * up) >= gap_m * gap_m;
  if (!start.knows_height || !in_prior || !doubted || std::abs(gap_m) < usual_height_gap_m) return;
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << prior.identity().name << " puts the start " << std::abs(gap_m) << " m " << (gap_m < 0 ? "lower" : "higher")
       << " than the initial pose: one of both heights is off, no scan tells which, and the sigmas of all heights say so";
  if (start.crs) text << "; --initial-lonlat without --initial-height trusts the prior";
  events.warn(text.str());
}

RunSummary summarise(const std::vector<MappedScan>& scans) {
  RunSummary summary;
  summary.num_scans = scans.size();
  std::vector<double> ms;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i) summary.length_m += (scans[i].T_map_sensor.translation() - scans[i - 1].T_map_sensor.translation()).norm();
    ms.push_back(1e3 * scans[i].step_s);
    summary.mean_scan_ms += ms.back() / static_cast<double>(scans.size());
  }
  summary.median_scan_ms = quantile(ms, 0.5);
  summary.p95_scan_ms = quantile(ms, 0.95);
  summary.num_anchored = count(scans, Verdict::anchored);
  summary.num_weak = count(scans, Verdict::weak);
  summary.num_dead_reckoned = count(scans, Verdict::dead_reckoned);
  summary.num_outside_prior = count(scans, Verdict::outside_prior);
  summary.num_motion_undone = static_cast<std::size_t>(std::count_if(scans.begin(), scans.end(), [](const MappedScan& s) { return s.motion_undone; }));
  summary.num_lost = count(scans, Verdict::lost);
  return summary;
}

}  // namespace

std::optional<RunSummary> run_mapper(const RunOptions& options, int threads, Overwrite overwrite, const Events& events) {
  Stopwatch watch;
  StageTimes times;
  const bool is_whole = options.resume && overwrite == Overwrite::refuse && fs::exists(options.output / "run.json");
  ResumableDirectory output(options.output, is_whole ? Overwrite::allow : overwrite, "run.json");
  const MapperOptions method = MapperOptions::preset(options.preset);
  const auto source = open_scans(options.scans, options.dataset);
  const ScanRange range = range_of(*source, options);
  const auto prior = options.prior.empty() ? nullptr : open_prior(options.prior, options.prior_options);
  warn_of_idle_times(options, events);
  warn_of_idle_stretches(options, events);
  warn_of_missing_scans(*source, range, events);
  const std::string identity = identity_of(options, method, *source, range, prior.get());
  if (is_whole) {
    leave_as_it_is(output, options.output, identity, events);
    return std::nullopt;
  }
  const Scan first = first_scan(*source, range.first);
  auto motion = std::async(std::launch::async, [&] { return motion_at_start(*source, range.first, range.last); });   // as long as finding the CRS takes
  const Start start = find_start(options.initial, prior.get(), first.points, method.prior_radius_m);
  if (prior) warn_of_height(start, *prior, events);
  std::optional<NearTiles> near;
  if (prior) near.emplace(*prior, start.frame, method.prior_radius_m, threads);
  std::optional<OnlinePass> pass(OnlinePass{Mapper(method, near, {start.T_map_sensor, motion.get(), period_at_start(*source, range.first, range.last), start.knows_height}, threads), {}});
  Checkpoints checkpoints(output, identity, options.checkpoint_s, events);
  if (options.resume)
    resume(*pass, checkpoints, output.checkpoint_file(), range, events);
  else
    tell_of_checkpoint(output, events);
  times.start_s = watch.lap();

  map_scans(*pass, *source, range, options, checkpoints, events);
  times.online_s = watch.lap();

  std::vector<MappedScan> scans = pass->mapper.finish([&](std::size_t index) { return source->read(index); });
  for (std::size_t i = 0; i < scans.size(); ++i) scans[i].step_s = pass->step_s[i];
  pass.reset();   // the map needs room of its own
  return_freed_memory();
  warn_of_empty_scans(scans, *source, events);
  if (prior) warn_of_bad_start(scans, *prior, events);
  if (prior) warn_of_height_gap(scans, start, *prior, events);
  times.estimate_s = watch.lap();

  RunSummary summary = summarise(scans);
  write_trajectories(output.temporary_path(), scans, start.frame);
  if (!options.no_map)
    summary.num_map_points = write_map(output.temporary_path() / "map", *source, placed(scans), start.frame, map_manifest(options, prior.get(), start, *source, range),
                                       options.map, threads, events).num_points;
  times.map_s = watch.lap();
  summary.total_s = watch.seconds();
  summary.peak_memory_bytes = peak_memory_bytes();
  write_run_report(output.temporary_path() / "run.json", {options, method, *source, range, prior.get(), start, scans, summary, times, threads});
  output.commit();
  return summary;
}

}  // namespace priormap
