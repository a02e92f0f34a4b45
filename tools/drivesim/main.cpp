#include <cstdio>

#include <priormap/cli/tool_app.hpp>
#include <priormap/simulation/drive.hpp>

int main(int argc, char** argv) {
  priormap::cli::ToolApp app("drivesim", "Simulates a LiDAR drive through a town: scans, the truth, and the geodata a user would have");
  priormap::DriveOptions options;
  std::string output;
  app.option("--town", options.town, {"'generated', or an OSM file whose buildings and streets to use"});
  app.option("--trajectory", options.trajectory, {"poses to follow (KITTI rows or TUM); without it a route along the streets"});
  app.choice("--sensor", options.sensor, priormap::lidar_names(), "the sensor");
  app.option("--seed", options.seed, {"same seed and options, same bytes"});
  app.required("-o,--output", output, "directory to write");
  app.options(options.route, "Drive");
  app.options(options.kidnap, "Kidnapping");
  app.options(options.platform, "Platform");
  app.options(options.noise, "Sensor noise");
  app.options(options.town_options, "Town");
  app.options(options.errors, "Errors of the sources");
  return app.run(argc, argv, [&](const priormap::cli::ToolContext& context) {
    const auto summary = priormap::simulate_drive(options, output, context.overwrite, context.threads, context.events);
    std::printf("scans %zu\npoints_per_scan %zu\nlength_m %.1f\nbuildings %zu\nbuildings_missing %zu\nbuildings_without_height %zu\nms_per_scan %.1f\n",
                summary.num_scans, summary.num_points / summary.num_scans, summary.length_m, summary.num_buildings, summary.num_missing,
                summary.num_default_height, summary.simulate_ms_per_scan);
  });
}
