#include "config_file.hpp"

#include <iterator>

#include <priormap/core/error.hpp>

#include "nearest_name.hpp"
#include "toml.hpp"

namespace priormap::cli {
namespace {

[[noreturn]] void fail(const TomlEntry& entry, const std::string& cause) { throw UsageError("line " + std::to_string(entry.line) + ": " + entry.key + cause); }

const CLI::Option* find(const CLI::App& app, const std::string& key) {
  const CLI::Option* option = app.get_option_no_throw("--" + key);
  return option ? option : app.get_option_no_throw(key.size() == 1 ? "-" + key : key);
}

std::vector<std::string> keys_of(const CLI::App& app) {
  std::vector<std::string> keys;
  for (const CLI::Option* option : app.get_options([](const CLI::Option* each) { return each->get_configurable(); })) keys.push_back(option->get_single_name());
  return keys;
}

void check(const TomlEntry& entry, const CLI::Option& option) {
  const bool is_flag = option.get_expected_min() == 0;
  if (entry.values.empty()) fail(entry, " has no value");
  if (entry.values.size() > 1 && (is_flag || option.get_expected_max() == 1)) fail(entry, " takes one value");
  if (is_flag && entry.values.front() != "true" && entry.values.front() != "false") fail(entry, " is true or false, not '" + entry.values.front() + "'");
}

}  // namespace

std::string shown_name(const CLI::Option& option) { return (option.get_positional() ? "" : "--") + option.get_single_name(); }

std::vector<std::string> long_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

std::vector<CLI::ConfigItem> ConfigFile::from_config(std::istream& input) const {
  const std::string text{std::istreambuf_iterator<char>(input), {}};
  std::vector<CLI::ConfigItem> result;
  for (const TomlEntry& entry : parse_toml(text)) {
    const CLI::Option* option = find(app_, entry.key);
    if (!option || !option->get_configurable()) fail(entry, " is no option that a configuration sets" + meant(entry.key, keys_of(app_)));
    check(entry, *option);
    if (option->empty()) lines_[shown_name(*option)] = entry.line;
    result.emplace_back();
    result.back().name = entry.key;
    result.back().inputs = entry.values;
  }
  return result;
}

}  // namespace priormap::cli
