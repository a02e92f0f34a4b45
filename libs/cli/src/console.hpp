#pragma once
#include <chrono>
#include <mutex>
#include <string>

#include <priormap/core/events.hpp>

namespace priormap::cli {

/// Messages and progress on stderr: text for people, or one JSON object a line. Safe from any thread.
class Console {
 public:
  Console(std::string tool, bool quiet, bool json);

  void error(const std::string& message, int exit_code);
  /// Events that print here; hold them no longer than this console.
  Events events();

 private:
  void message(const char* level, const std::string& text);
  void progress(const std::string& stage, double fraction);
  void clear_progress_line();

  std::string tool_;
  bool quiet_, json_, terminal_;
  std::mutex mutex_;
  std::size_t progress_width_ = 0;
  std::string stage_;
  std::chrono::steady_clock::time_point last_progress_{};
};

}  // namespace priormap::cli
