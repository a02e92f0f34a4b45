#pragma once
#include <functional>
#include <string>

namespace priormap {

/// What a library tells the program that called it. Libraries never print. Any member may be empty.
struct Events {
  std::function<void(const std::string& message)> warning;
  std::function<void(const std::string& message)> info;
  std::function<void(const std::string& stage, double fraction)> progress;  ///< fraction in [0, 1]

  void warn(const std::string& message) const { if (warning) warning(message); }
  void inform(const std::string& message) const { if (info) info(message); }
  void advance(const std::string& stage, double fraction) const { if (progress) progress(stage, fraction); }
};

}  // namespace priormap
