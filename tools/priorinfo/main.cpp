#include <iostream>
#include <string>
#include <vector>

#include <priormap/cli/tool_app.hpp>
#include <priormap/core/error.hpp>
#include <priormap/prior/check_prior.hpp>
#include <priormap/prior/describe_prior.hpp>
#include <priormap/prior/prior_lookup.hpp>

namespace {

[[noreturn]] void fail(const std::vector<std::string>& faults) {
  const std::size_t others = faults.size() - 1;
  throw priormap::FormatError(faults.front() + (others == 0 ? "" : " (and " + std::to_string(others) + " more)"));
}

void make_lookup(const priormap::PriorStore& prior, const priormap::cli::ToolContext& context) {
  const std::size_t made = priormap::PriorLookup(prior, priormap::units_of(prior.manifest())).make_files(context.threads, context.events);
  context.events.inform((prior.directory() / priormap::lookup_folder_name).string() + ": made " + std::to_string(made) + " of " +
                        std::to_string(prior.index().size()) + " files, the others are sound");
}

}  // namespace

int main(int argc, char** argv) {
  priormap::cli::ToolApp app("priorinfo", "What is in a prior, and whether it is whole");
  std::string directory;
  bool json = false, check = false, index = false;
  app.positional("PRIOR", directory, "prior directory", true);
  app.flag("--json", json, "the manifest as JSON, with --check also the list of faults");
  app.flag("--check", check, "verifies schema, index, hashes, bounds and CRS; exit code 1 on a fault");
  app.flag("--index", index, "makes the lookup that mapper else makes tile by tile when it first comes there");
  return app.run(argc, argv, [&](const priormap::cli::ToolContext& context) {
    std::vector<std::string> faults;
    if (check) faults = priormap::check_prior(directory, context.threads, context.events);
    if (!faults.empty() && !json) fail(faults);
    const priormap::PriorStore prior(directory);
    if (index) make_lookup(prior, context);
    std::cout << (json ? priormap::describe_prior_json(prior, check ? &faults : nullptr) : priormap::describe_prior(prior));
    if (!faults.empty()) fail(faults);
    if (check) context.events.inform(directory + ": no fault found");
  });
}
