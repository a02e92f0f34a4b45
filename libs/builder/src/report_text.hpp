#pragma once
#include <iomanip>
#include <optional>
#include <sstream>
#include <string>

#include <priormap/builder/sight_options.hpp>
#include <priormap/core/diagnostics.hpp>
#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

/// What the user of a builder reads at its end: a name and a value a line.
class ReportText {
 public:
  template <class Value>
  void line(const std::string& name, const Value& value) {
    text_ << std::left << std::setw(28) << name << value << '\n';
  }
  /// Of the prior that was written. @param sight  none: all points count as seen
  void lines_of(const PriorManifest& manifest, const std::optional<SightCounts>& sight) {
    line("points", manifest.num_points);
    if (sight) line("points out of sight", to_text(*sight));
    line("tiles", manifest.num_tiles);
    line("crs", manifest.crs);
    line("vertical", manifest.vertical.value_or("null"));
  }
  void lines_of(const Diagnostics& diagnostics) {
    for (const auto& [code, number] : diagnostics.counts()) line("diagnostic " + std::to_string(static_cast<int>(code)), number);
    for (const Diagnostics::Entry& entry : diagnostics.entries())
      text_ << "  " << static_cast<int>(entry.code) << ' ' << entry.feature << ": " << entry.message << '\n';
  }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

}  // namespace priormap
