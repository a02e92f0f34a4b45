#pragma once
#include <string>
#include <vector>

namespace priormap::cli {

struct TomlEntry {
  std::string key;
  std::vector<std::string> values;  ///< text of the value, or of each element of an array
  int line = 0;
};

/// The part of TOML 1.0 that a configuration needs: `key = value` with strings on one line, numbers, booleans and arrays of
/// them, comments. @throws UsageError naming the line for anything else, and for a key that occurs twice.
std::vector<TomlEntry> parse_toml(const std::string& text);

/// A TOML basic string.
std::string toml_string(const std::string& text);

}  // namespace priormap::cli
