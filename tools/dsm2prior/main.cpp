#include <iostream>
#include <string>
#include <vector>

#include <priormap/builder/raster_prior.hpp>
#include <priormap/cli/tool_app.hpp>
#include <priormap/core/version.hpp>

int main(int argc, char** argv) {
  using namespace priormap;
  cli::ToolApp app("dsm2prior", "Surface and terrain rasters as a prior");
  std::vector<std::string> inputs;
  std::string output;
  PriorOptions prior_options;
  RasterPriorOptions raster_options;
  app.positional("INPUT", inputs, "any raster that GDAL reads, heights in band 1; where several overlap the finer has the word", true);
  app.required("-o,--output", output, "PRIOR directory to write");
  app.choice("--kind", raster_options.kind, {"surface", "terrain"}, "terrain: points are class ground; surface: unclassified");
  app.options(raster_options, "Raster");
  app.options(prior_options, "Prior");
  return app.run(argc, argv, [&](const cli::ToolContext& context) {
    const RasterReport report = build_raster_prior({inputs.begin(), inputs.end()}, prior_options, raster_options, output, context.overwrite,
                                                   "dsm2prior " + std::string(version), context.threads, context.events);
    std::cout << to_text(report);
  });
}
