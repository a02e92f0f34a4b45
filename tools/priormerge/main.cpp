#include <filesystem>
#include <string>
#include <vector>

#include <priormap/cli/tool_app.hpp>
#include <priormap/core/version.hpp>
#include <priormap/prior/merge_priors.hpp>

namespace {

std::string summary(const priormap::MergeReport& report) {
  const auto part = [](std::uint64_t count, const char* what) { return count == 0 ? "" : ", " + std::to_string(count) + " " + what; };
  return std::to_string(report.kept) + " points in " + std::to_string(report.manifest.num_tiles) + " tiles" +
         part(report.duplicates, "duplicates united") + part(report.under_models, "raster points inside building models left out") +
         part(report.contradicted, "points of guessed heights left out, contradicted by a surface raster") +
         part(report.thinned, "left out near points of higher precedence");
}

}  // namespace

int main(int argc, char** argv) {
  priormap::cli::ToolApp app("priormerge", "Joins priors into one, whatever their tiles");
  priormap::MergeOptions options;
  std::vector<std::string> inputs;
  std::string output;
  app.positional("PRIOR", inputs, "prior directories; earlier ones take precedence", true);
  app.required("-o,--output", output, "PRIOR directory to write");
  app.options(options);
  return app.run(argc, argv, [&](const priormap::cli::ToolContext& context) {
    const std::vector<std::filesystem::path> paths(inputs.begin(), inputs.end());
    const std::string generator = "priormerge " + std::string(priormap::version);
    const auto report = priormap::merge_priors(paths, output, options, context.overwrite, context.threads, generator, context.events);
    context.events.inform(output + ": " + summary(report));
  });
}
