#include <cstdio>

#include <priormap/cli/tool_app.hpp>
#include <priormap/mapping/run_mapper.hpp>

namespace {

void print(const priormap::RunSummary& s) {
  std::printf("scans              %zu over %.1f m\n", s.num_scans, s.length_m);
  std::printf("poses              %zu anchored, %zu weak, %zu dead-reckoned, %zu outside the prior, %zu lost\n", s.num_anchored, s.num_weak,
              s.num_dead_reckoned, s.num_outside_prior, s.num_lost);
  std::printf("ms a scan          median %.1f, mean %.1f, p95 %.1f\n", s.median_scan_ms, s.mean_scan_ms, s.p95_scan_ms);
  std::printf("map                %llu points\n", static_cast<unsigned long long>(s.num_map_points));
  std::printf("whole run          %.1f s, %.0f MB peak memory\n", s.total_s, static_cast<double>(s.peak_memory_bytes) / 1e6);
}

}  // namespace

int main(int argc, char** argv) {
  priormap::cli::ToolApp app("mapper", "Maps a LiDAR recording against a prior, without GNSS and without drift");
  priormap::RunOptions options;
  std::string scans, prior, output, dataset = "auto";
  std::vector<std::string> datasets = priormap::dataset_names();
  datasets.insert(datasets.begin(), "auto");

  app.required("--scans", scans, "Recording: a folder as its dataset lays it out, or one scan");
  app.choice("--dataset", dataset, datasets, "How the recording is laid out (auto: from the files)");
  app.options(options.dataset);
  app.option("--start", options.start, {"scans to leave out at the beginning"});
  app.option("--limit", options.limit, {"scans to map at most; 0: all"});
  app.option("--prior", prior, {"PRIOR directory or a cloud (.las .pcd .ply); without it: odometry"});
  app.options(options.prior_options);
  app.options(options.initial);
  app.choice("--preset", options.preset, priormap::preset_names(), "Parameters of the method");
  app.option("--jobs", options.jobs, {"stretches of the drive mapped at once, only with --preset default; 1: the drive in one piece", "", 1, 1024});
  app.options(options.stretches);
  app.options(options.map);
  app.flag("--resume", options.resume, "Go on where a run with the same output was interrupted");
  app.option("--checkpoint", options.checkpoint_s, {"time between states kept beside OUT from which --resume goes on; 0: none are kept", "s", 0, 1e6});
  app.flag("--no-map", options.no_map, "Write trajectories and report only");
  app.required("-o,--output", output, "OUT directory to write");

  return app.run(argc, argv, [&](const priormap::cli::ToolContext& context) {
    options.scans = scans;
    options.prior = prior;
    options.output = output;
    if (dataset != "auto") options.dataset.name = dataset;
    if (const auto summary = priormap::run_mapper(options, context.threads, context.overwrite, context.events)) print(*summary);
  });
}
