#pragma once
#include <filesystem>

namespace priormap {

/// A new file or directory `.tmp-HOST-PID-N-NAME` in which an output NAME is made. As long as this object lives it holds a lock (flock) on it, and the kernel lets go of that however the
/// program ends: what no program holds was left by one that was killed, and the next program on this host that makes the same output removes it. On file systems
/// without locks it stays.
class TemporaryOutput {
 public:
  enum class Kind { file, directory };
  /// @param folder  where to make it: with the target on one file system, so that it can be renamed
  /// @throws IoError naming the target
  TemporaryOutput(Kind kind, const std::filesystem::path& target, const std::filesystem::path& folder);
  ~TemporaryOutput();
  TemporaryOutput(const TemporaryOutput&) = delete;
  TemporaryOutput& operator=(const TemporaryOutput&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace priormap
