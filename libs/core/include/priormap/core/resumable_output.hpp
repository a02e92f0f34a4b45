#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include <priormap/core/atomic_output.hpp>

namespace priormap {

/// An AtomicDirectory whose making goes on where it stood after the program was killed. It is made in a folder .NAME.unfinished beside the target, which also
/// holds the last checkpoint and goes away with the commit, or when there is no checkpoint to keep. One program at a time makes a target.
class ResumableDirectory {
 public:
  /// Removes what an interrupted program left but its checkpoint: that stays until another one takes its place.
  /// @throws IoError as AtomicDirectory, and while another program makes the same target
  ResumableDirectory(std::filesystem::path target, Overwrite overwrite, std::string marker_file);
  ~ResumableDirectory();
  ResumableDirectory(const ResumableDirectory&) = delete;
  ResumableDirectory& operator=(const ResumableDirectory&) = delete;

  const std::filesystem::path& temporary_path() const { return output_.temporary_path(); }
  /// What was kept last, as it was given; none: nothing, or not whole.
  std::optional<std::string> checkpoint() const;
  /// Where it is kept: a file there without a checkpoint() is damaged.
  std::filesystem::path checkpoint_file() const;
  /// Keeps a checkpoint in place of the last one, whole or not at all. May run in a thread of its own. @throws IoError
  void keep(const std::string& checkpoint);
  void discard_checkpoint();
  /// Puts the directory in place and removes the checkpoint. @throws IoError
  void commit();

 private:
  /// Held by this program alone.
  class Lock {
   public:
    Lock(const std::filesystem::path& folder, const std::filesystem::path& target);
    ~Lock();

   private:
    int descriptor_;
  };
  void remove_leftovers();

  AtomicDirectory output_;
  std::filesystem::path folder_;
  Lock lock_;
};

}  // namespace priormap
