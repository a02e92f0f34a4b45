#pragma once
#include <limits>
#include <string_view>

namespace priormap {

/// Describes one option beside the field it sets. An options aggregate offers
///   template <class Visitor> void describe(Visitor& visit) { visit("default-height", default_height_m, {"...", "m", 0.1, 1000}); }
/// and from that one place come the command line, the config file, --help, the man page and run.json.
struct OptionField {
  std::string_view help;
  std::string_view unit = "";
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

}  // namespace priormap
