#include <iostream>
#include <string>
#include <vector>

#include <priormap/builder/outline_prior.hpp>
#include <priormap/cli/tool_app.hpp>
#include <priormap/core/version.hpp>
#include <priormap/sources/osm_footprints.hpp>

namespace {

using namespace priormap;

OutlineInput read_input(const std::vector<std::string>& inputs, int threads, Diagnostics& diagnostics, const Events& events) {
  const std::vector<HashedFile> files = distinct_files({inputs.begin(), inputs.end()});
  std::vector<std::filesystem::path> paths;
  for (const HashedFile& file : files) paths.push_back(file.path);
  const std::vector<std::optional<Crs>> crs(files.size(), Crs::parse("EPSG:4326"));
  return {read_osm_footprints(paths, threads, diagnostics, events), files, crs, "osm", "ODbL-1.0", "OpenStreetMap contributors"};
}

}  // namespace

int main(int argc, char** argv) {
  cli::ToolApp app("osm2prior", "Buildings of OpenStreetMap as a prior");
  std::vector<std::string> inputs;
  std::string output;
  PriorOptions prior_options;
  OutlineOptions outline_options;
  app.positional("INPUT", inputs, ".osm.pbf, .osm, .osm.gz or .osm.bz2; several are one data set", true);
  app.required("-o,--output", output, "PRIOR directory to write");
  app.options(prior_options, "Prior");
  app.options(outline_options, "Buildings");
  return app.run(argc, argv, [&](const cli::ToolContext& context) {
    Diagnostics diagnostics;
    OutlineInput input = read_input(inputs, context.threads, diagnostics, context.events);
    const OutlineReport report = build_outline_prior(std::move(input), prior_options, outline_options, output, context.overwrite,
                                                     "osm2prior " + std::string(version), std::move(diagnostics), context.threads, context.events);
    std::cout << to_text(report);
  });
}
