#include <priormap/core/resumable_output.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/core/output_file.hpp>

#include "pending_outputs.hpp"

namespace priormap {
namespace fs = std::filesystem;
namespace {

constexpr const char* checkpoint_name = "checkpoint";
constexpr const char* magic = "priormap checkpoint 1";

std::string digest_of(const std::string& bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.hex_digest();
}

}  // namespace

ResumableDirectory::Lock::Lock(const fs::path& folder, const fs::path& target) : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) throw IoError(folder, std::string("cannot be opened: ") + std::strerror(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;   // file systems without locks have to do without
  ::close(descriptor_);
  throw IoError(target, "is being made by another program");
}
ResumableDirectory::Lock::~Lock() { ::close(descriptor_); }

ResumableDirectory::ResumableDirectory(fs::path target, Overwrite overwrite, std::string marker_file)
    : output_(std::move(target), overwrite, std::move(marker_file), Workplace::own_folder), folder_(output_.temporary_path().parent_path()), lock_(folder_, output_.target()) {
  remove_leftovers();
  if (!fs::exists(checkpoint_file())) PendingOutputs::instance().add(folder_);
}

ResumableDirectory::~ResumableDirectory() {
  std::error_code error;
  if (!fs::exists(checkpoint_file(), error)) PendingOutputs::instance().discard(folder_);
}

void ResumableDirectory::remove_leftovers() {
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error))
    if (const std::string name = entry->path().filename().string(); entry->path() != output_.temporary_path() && name != checkpoint_name && !name.starts_with(".replaced")) fs::remove_all(entry->path(), error);
  if (error) throw IoError(folder_, "cannot be cleared: " + error.message());
}

fs::path ResumableDirectory::checkpoint_file() const { return folder_ / checkpoint_name; }

std::optional<std::string> ResumableDirectory::checkpoint() const {
  std::ifstream file(checkpoint_file(), std::ios::binary);
  std::string header;
  if (!std::getline(file, header)) return std::nullopt;
  std::ostringstream bytes;
  bytes << file.rdbuf();
  std::string checkpoint = std::move(bytes).str();
  if (header != magic + (" " + digest_of(checkpoint))) return std::nullopt;
  return checkpoint;
}

void ResumableDirectory::keep(const std::string& checkpoint) {
  AtomicFile kept(checkpoint_file(), Overwrite::allow);
  OutputFile file(kept.temporary_path());
  file << magic << ' ' << digest_of(checkpoint) << '\n' << checkpoint;
  file.close();
  PendingOutputs::instance().forget(folder_);   // from here on it holds what outlives an interruption
  kept.commit();
}

void ResumableDirectory::discard_checkpoint() {
  std::error_code error;
  fs::remove(checkpoint_file(), error);
  if (error) throw IoError(checkpoint_file(), "cannot be removed: " + error.message());
  PendingOutputs::instance().add(folder_);
}

void ResumableDirectory::commit() {
  output_.commit();
  PendingOutputs::instance().discard(folder_);
}

}  // namespace priormap
