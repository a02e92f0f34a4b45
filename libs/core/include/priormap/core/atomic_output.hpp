#pragma once
#include <filesystem>
#include <memory>
#include <string>

namespace priormap {

enum class Overwrite { refuse, allow };
class TemporaryOutput;

/// A file that appears under its name only when it is whole. Write to `temporary_path()`, then `commit()`.
/// Without commit the temporary file is removed, and what a killed program left of the same target as soon as this is made again. Missing parent folders are created; a symbolic link is followed.
class AtomicFile {
 public:
  /// @throws IoError when `target` exists and overwriting is refused, or its folder cannot be written.
  AtomicFile(std::filesystem::path target, Overwrite overwrite);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary_path() const;
  /// Flushes to disk and renames. What wrote the file must have been closed and checked before (see OutputFile). @throws IoError
  void commit();

 private:
  std::filesystem::path target_;
  std::unique_ptr<TemporaryOutput> temporary_;
  Overwrite overwrite_;
  bool committed_ = false;
};

/// Where a directory is made: beside its target, or in a folder .NAME.unfinished there (see ResumableDirectory), which stays.
enum class Workplace { beside, own_folder };

/// A directory that appears under its name only when it is whole. An existing directory is replaced only with
/// `Overwrite::allow` and only when it is empty or holds `marker_file` (so that a tool never empties a stranger's folder).
class AtomicDirectory {
 public:
  /// @throws IoError as above.
  AtomicDirectory(std::filesystem::path target, Overwrite overwrite, std::string marker_file, Workplace workplace = Workplace::beside);
  ~AtomicDirectory();
  AtomicDirectory(const AtomicDirectory&) = delete;
  AtomicDirectory& operator=(const AtomicDirectory&) = delete;

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& temporary_path() const;
  /// Renames into place; the replaced directory is removed last. @throws IoError
  void commit();

 private:
  std::filesystem::path target_;
  std::unique_ptr<TemporaryOutput> temporary_;
  Overwrite overwrite_;
  std::string marker_file_;
  bool committed_ = false;
};

/// Removes the temporary files and directories of all outputs not yet committed: for a program that is being interrupted.
void discard_pending_outputs();

}  // namespace priormap
