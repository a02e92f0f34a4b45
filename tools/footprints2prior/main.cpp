#include <iostream>
#include <string>
#include <vector>

#include <priormap/builder/outline_prior.hpp>
#include <priormap/cli/tool_app.hpp>
#include <priormap/core/version.hpp>
#include <priormap/sources/ogr_footprints.hpp>

namespace {

using namespace priormap;

OutlineInput read_input(const std::vector<std::string>& inputs, const FootprintFields& fields, Diagnostics& diagnostics) {
  OutlineInput input{{}, distinct_files({inputs.begin(), inputs.end()}), {}, "footprints", "", ""};
  for (std::size_t i = 0; i < input.files.size(); ++i)
    input.crs.push_back(read_ogr_footprints(input.files[i].path, fields, diagnostics, input.footprints, static_cast<std::uint16_t>(i)));
  return input;
}

}  // namespace

int main(int argc, char** argv) {
  cli::ToolApp app("footprints2prior", "Outlines of buildings as a prior");
  std::vector<std::string> inputs;
  std::string output;
  FootprintFields fields;
  PriorOptions prior_options;
  OutlineOptions outline_options;
  app.positional("INPUT", inputs, "any polygon layer that OGR reads: GeoPackage, Shapefile, GeoJSON, FlatGeobuf ...", true);
  app.required("-o,--output", output, "PRIOR directory to write");
  app.options(fields, "Layers");
  app.options(prior_options, "Prior");
  app.options(outline_options, "Buildings");
  return app.run(argc, argv, [&](const cli::ToolContext& context) {
    Diagnostics diagnostics;
    OutlineInput input = read_input(inputs, fields, diagnostics);
    const OutlineReport report = build_outline_prior(std::move(input), prior_options, outline_options, output, context.overwrite,
                                                     "footprints2prior " + std::string(version), std::move(diagnostics), context.threads, context.events);
    std::cout << to_text(report);
  });
}
