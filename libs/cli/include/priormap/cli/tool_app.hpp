#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/events.hpp>
#include <priormap/core/option_field.hpp>

namespace priormap::cli {

/// What every program knows from the options that all of them share.
struct ToolContext {
  int threads = 1;
  Overwrite overwrite = Overwrite::refuse;
  Events events;   ///< warnings, information and progress to stderr, as --quiet and --log-json ask
};

/// One program: its options, its config file, its exit codes. Offers --help, --version, --config FILE (TOML; the command line wins), --dump-config,
/// --threads, --quiet, --log-json, --overwrite to all programs alike.
///
///   int main(int argc, char** argv) {
///     priormap::cli::ToolApp app("osm2prior", "Buildings of OpenStreetMap as prior tiles");
///     OutlineOptions options;  std::vector<std::string> inputs;  std::string output;
///     app.positional("INPUT", inputs, "...", true);
///     app.required("-o,--output", output, "PRIOR directory to write");
///     app.options(options);                        // every field, by OutlineOptions::describe
///     return app.run(argc, argv, [&](const ToolContext& context) { ...one library call... });
///   }
///
/// `run` maps exceptions to exit codes: UsageError and bad options 2, everything else 1, with one line "NAME: message" on stderr.
class ToolApp {
 public:
  ToolApp(std::string name, std::string description);
  ~ToolApp();

  void positional(const std::string& name, std::vector<std::string>& values, const std::string& help, bool required);
  void positional(const std::string& name, std::string& value, const std::string& help, bool required);
  void required(const std::string& flags, std::string& value, const std::string& help);
  void flag(const std::string& flags, bool& value, const std::string& help);
  void choice(const std::string& flags, std::string& value, const std::vector<std::string>& allowed, const std::string& help);

  // "--name,-n": numbers are checked against the range, defaults are shown in --help.
  void option(const std::string& flags, double& value, const OptionField& field);
  void option(const std::string& flags, int& value, const OptionField& field);
  void option(const std::string& flags, std::uint64_t& value, const OptionField& field);
  void option(const std::string& flags, bool& value, const OptionField& field);        // --name / --name=false
  void option(const std::string& flags, std::string& value, const OptionField& field);
  void option(const std::string& flags, std::vector<std::string>& value, const OptionField& field);   // repeatable
  void option(const std::string& flags, std::vector<double>& value, const OptionField& field);        // a,b,c
  void option(const std::string& flags, std::optional<double>& value, const OptionField& field);
  void option(const std::string& flags, std::optional<std::string>& value, const OptionField& field);

  /// All fields of an options aggregate (see OptionField), as "--name".
  template <class Options>
  void options(Options& options_aggregate, const std::string& group = "") {
    begin_group(group);
    auto visit = [this](const std::string& name, auto& value, const OptionField& field) { option("--" + name, value, field); };
    options_aggregate.describe(visit);
    begin_group("");
  }

  int run(int argc, char** argv, const std::function<void(const ToolContext&)>& body);

 private:
  void begin_group(const std::string& name);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap::cli
