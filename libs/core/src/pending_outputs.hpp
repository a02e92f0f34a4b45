#pragma once
#include <filesystem>
#include <functional>
#include <mutex>
#include <set>

namespace priormap {

/// Temporary paths of outputs that are not committed yet. One list for the process: a signal arrives at the process, not at the object that owns the file.
class PendingOutputs {
 public:
  static PendingOutputs& instance();

  void add(const std::filesystem::path& path);
  /// Leaves the path where it is.
  void forget(const std::filesystem::path& path);
  void discard(const std::filesystem::path& path);
  void discard_all();
  /// Runs `rename` while no interruption can remove the path, then forgets the path.
  void publish(const std::filesystem::path& path, const std::function<void()>& rename);

 private:
  std::mutex mutex_;
  std::set<std::filesystem::path> paths_;
};

}  // namespace priormap
