#include <iostream>
#include <string>
#include <vector>

#include <priormap/builder/model_prior.hpp>
#include <priormap/cli/tool_app.hpp>
#include <priormap/core/version.hpp>

int main(int argc, char** argv) {
  using namespace priormap;
  cli::ToolApp app("citygml2prior", "Building models of CityGML and CityJSON as a prior");
  std::vector<std::string> inputs;
  std::string output;
  PriorOptions prior_options;
  ModelOptions model_options;
  app.positional("INPUT", inputs, "CityGML .gml .xml .gz, CityJSON .json, CityJSONSeq .jsonl", true);
  app.required("-o,--output", output, "PRIOR directory to write");
  app.options(prior_options, "Prior");
  app.options(model_options, "Models");
  return app.run(argc, argv, [&](const cli::ToolContext& context) {
    std::cout << to_text(build_model_prior({inputs.begin(), inputs.end()}, prior_options, model_options, output, context.overwrite,
                                           "citygml2prior " + std::string(version), context.threads, context.events));
  });
}
