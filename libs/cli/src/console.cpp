#include "console.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

namespace priormap::cli {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  return text;
}

void print_json(const nlohmann::ordered_json& object) {
  std::cerr << object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
}

}  // namespace

Console::Console(std::string tool, bool quiet, bool json)
    : tool_(std::move(tool)), quiet_(quiet), json_(json), terminal_(::isatty(STDERR_FILENO) == 1) {}

void Console::error(const std::string& text, int exit_code) {
  const std::lock_guard lock(mutex_);
  clear_progress_line();
  if (json_)
    print_json({{"tool", tool_}, {"level", "error"}, {"message", one_line(text)}, {"exit_code", exit_code}});
  else
    std::cerr << tool_ << ": " << one_line(text) << std::endl;
}

Events Console::events() {
  if (quiet_) return {};
  Events events;
  events.warning = [this](const std::string& text) { message("warning", text); };
  events.info = [this](const std::string& text) { message("info", text); };
  if (json_ || terminal_) events.progress = [this](const std::string& stage, double fraction) { progress(stage, fraction); };
  return events;
}

void Console::message(const char* level, const std::string& text) {
  const std::lock_guard lock(mutex_);
  clear_progress_line();
  if (json_)
    print_json({{"tool", tool_}, {"level", level}, {"message", text}});
  else
    std::cerr << tool_ << ": " << (level == std::string("warning") ? "warning: " : "") << one_line(text) << std::endl;
}

void Console::progress(const std::string& stage, double fraction) {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  const auto interval = std::chrono::milliseconds(json_ ? 1000 : 100);
  if (stage == stage_ && fraction < 1 && now - last_progress_ < interval) return;
  stage_ = stage;
  last_progress_ = now;
  if (json_) return print_json({{"tool", tool_}, {"level", "progress"}, {"stage", stage}, {"fraction", fraction}});

  clear_progress_line();
  if (fraction >= 1) {
    std::cerr << std::flush;
    return;
  }
  const std::string line = stage + " " + std::to_string(std::lround(100 * fraction)) + " %";
  std::cerr << line << std::flush;
  progress_width_ = line.size();
}

void Console::clear_progress_line() {
  if (progress_width_ > 0) std::cerr << '\r' << std::string(progress_width_, ' ') << '\r';
  progress_width_ = 0;
}

}  // namespace priormap::cli
