#include "pending_outputs.hpp"

#include <priormap/core/atomic_output.hpp>

namespace priormap {
namespace {

// Other threads may still be creating files inside.
void remove_tree(const std::filesystem::path& path) {
  std::error_code error;
  for (int attempt = 0; attempt < 100; ++attempt) {
    std::filesystem::remove_all(path, error);
    if (!error) return;
  }
}

}  // namespace

PendingOutputs& PendingOutputs::instance() {
  static PendingOutputs instance;
  return instance;
}

void PendingOutputs::add(const std::filesystem::path& path) {
  const std::lock_guard lock(mutex_);
  paths_.insert(path);
}

void PendingOutputs::forget(const std::filesystem::path& path) {
  const std::lock_guard lock(mutex_);
  paths_.erase(path);
}

void PendingOutputs::discard(const std::filesystem::path& path) {
  const std::lock_guard lock(mutex_);
  remove_tree(path);
  paths_.erase(path);
}

void PendingOutputs::discard_all() {
  const std::lock_guard lock(mutex_);
  for (const auto& path : paths_) remove_tree(path);
  paths_.clear();
}

void PendingOutputs::publish(const std::filesystem::path& path, const std::function<void()>& rename) {
  const std::lock_guard lock(mutex_);
  rename();
  paths_.erase(path);
}

void discard_pending_outputs() { PendingOutputs::instance().discard_all(); }

}  // namespace priormap
