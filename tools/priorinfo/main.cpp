#include <iostream>
#include <string>
#include <vector>

#include <priormap/cli/tool_app.hpp>
#include <priormap/core/error.hpp>
#include <priormap/prior/check_prior.hpp>
#include <priormap/prior/describe_prior.hpp>

namespace {

[[noreturn]] void fail(const std::vector<std::string>& faults) {
  const std::size_t others = faults.size() - 1;
  throw priormap::FormatError(faults.front() + (others == 0 ? "" : " (and " + std::to_string(others) + " more)"));
}

}  // namespace

int main(int argc, char** argv) {
  priormap::cli::ToolApp app("priorinfo", "What is in a prior, and whether it is whole");
  std::string directory;
  bool json = false, check = false;
  app.positional("PRIOR", directory, "prior directory", true);
  app.flag("--json", json, "the manifest as JSON, with --check also the list of faults");
  app.flag("--check", check, "verifies schema, index, hashes, bounds and CRS; exit code 1 on a fault");
  return app.run(argc, argv, [&](const priormap::cli::ToolContext& context) {
    std::vector<std::string> faults;
    if (check) faults = priormap::check_prior(directory, context.threads, context.events);
    if (!faults.empty() && !json) fail(faults);
    const priormap::PriorStore prior(directory);
    std::cout << (json ? priormap::describe_prior_json(prior, check ? &faults : nullptr) : priormap::describe_prior(prior));
    if (!faults.empty()) fail(faults);
    if (check) context.events.inform(directory + ": no fault found");
  });
}
