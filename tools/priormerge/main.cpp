#include <iostream>
#include <string>
#include <vector>

#include <priormap/cli/tool_app.hpp>
#include <priormap/core/version.hpp>
#include <priormap/prior/merge_priors.hpp>

int main(int argc, char** argv) {
  using namespace priormap;
  cli::ToolApp app("priormerge", "Joins priors into one, whatever their tiles");
  MergeOptions options;
  std::vector<std::string> inputs;
  std::string output;
  app.positional("PRIOR", inputs, "prior directories; earlier ones take precedence", true);
  app.required("-o,--output", output, "PRIOR directory to write");
  app.options(options);
  return app.run(argc, argv, [&](const cli::ToolContext& context) {
    const MergeReport report = merge_priors({inputs.begin(), inputs.end()}, output, options, context.overwrite, context.threads,
                                            "priormerge " + std::string(version), context.events);
    std::cout << to_text(report);
  });
}
