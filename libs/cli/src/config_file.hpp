#pragma once
#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace priormap::cli {

/// The name by which users know an option: --output, or INPUT of a positional.
std::string shown_name(const CLI::Option& option);
/// The long names, without dashes, of the options that the command line takes.
std::vector<std::string> long_names(const CLI::App& app);

/// Lets CLI11 read configurations by our TOML parser; its own cuts strings at '#', knows no escapes and does not say where a fault is.
class ConfigFile : public CLI::Config {
 public:
  /// @param lines  gets, by shown_name, the line of each option that the file sets and the command line does not
  ConfigFile(const CLI::App& app, std::map<std::string, int>& lines) : app_(app), lines_(lines) {}

  std::string to_config(const CLI::App*, bool, bool, std::string) const override { return {}; }
  /// @throws UsageError "line N: ..." for text that is no TOML, keys that are no options, and values of the wrong number
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

 private:
  const CLI::App& app_;
  std::map<std::string, int>& lines_;
};

}  // namespace priormap::cli
