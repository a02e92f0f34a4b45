#include <iostream>
#include <optional>
#include <string>

#include <priormap/cli/tool_app.hpp>
#include <priormap/core/error.hpp>
#include <priormap/prior/export_prior.hpp>

int main(int argc, char** argv) {
  priormap::cli::ToolApp app("priorexport", "A prior as one cloud, or as a map for Autoware");
  priormap::ExportOptions options;
  priormap::AutowareOptions autoware_options;
  std::string directory;
  std::optional<std::string> file, autoware;
  app.positional("PRIOR", directory, "prior directory", true);
  app.option("-o,--output", file, {"cloud to write: .las, .pcd, .ply or .xyz; those without a CRS get a .georef.json beside them"});
  app.option("--autoware", autoware, {"directory to write: pointcloud_map.pcd/, pointcloud_map_metadata.yaml, map_projector_info.yaml"});
  app.options(options);
  app.options(autoware_options);
  return app.run(argc, argv, [&](const priormap::cli::ToolContext& context) {
    if (!file && !autoware) throw priormap::UsageError("nothing to write: give -o FILE, --autoware DIR or both");
    const priormap::PriorStore prior(directory);
    const auto report = [](const std::string& path, std::uint64_t points) { std::cout << path << ": " << points << " points\n"; };
    if (file) report(*file, priormap::export_cloud(prior, *file, options, context.overwrite, context.events));
    if (autoware)
      report(*autoware, priormap::export_autoware(prior, *autoware, options, autoware_options, context.overwrite, context.events));
  });
}
