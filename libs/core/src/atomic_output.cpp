#include <priormap/core/atomic_output.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <priormap/core/error.hpp>

#include "pending_outputs.hpp"
#include "temporary_output.hpp"

namespace priormap {
namespace fs = std::filesystem;
namespace {

std::string cause(const char* what) { return std::string(what) + ": " + std::strerror(errno); }

fs::path resolved(const fs::path& target) {
  std::error_code error;
  fs::path path = fs::absolute(target).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const fs::path followed = fs::is_symlink(path, error) ? fs::canonical(path, error) : path;
  return error ? path : followed;
}

void create_parent(const fs::path& target) {
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  if (error) throw IoError(target.parent_path(), "cannot be created: " + error.message());
}

[[noreturn]] void refuse_existing(const fs::path& target) { throw IoError(target, "exists already; --overwrite replaces it"); }

void sync_parent(const fs::path& target) {
  const int folder = ::open(target.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

void sync_or_throw(const fs::path& path, const fs::path& target, int (*sync)(int)) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw IoError(target, cause("cannot be written"));
  const int failed = sync(descriptor);
  const int error = errno;
  ::close(descriptor);
  errno = error;
  if (failed) throw IoError(target, cause("cannot be written"));
}

/// renameat2 where the file system knows the flag.
bool rename_with(const fs::path& from, const fs::path& to, unsigned flags) {
  return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0;
}
bool flag_unsupported() { return errno == EINVAL || errno == ENOSYS; }

void rename_to_new_name(const fs::path& from, const fs::path& to) {
  if (rename_with(from, to, RENAME_NOREPLACE)) return;
  if (errno == EEXIST || (flag_unsupported() && fs::exists(to))) refuse_existing(to);
  if (flag_unsupported() && ::rename(from.c_str(), to.c_str()) == 0) return;
  throw IoError(to, cause("cannot be put in place"));
}

/// Afterwards `to` holds what was `from`, and `from` what was `to`.
void exchange_directories(const fs::path& from, const fs::path& to) {
  if (rename_with(from, to, RENAME_EXCHANGE)) return;
  const fs::path old = from.parent_path() / (".replaced" + from.filename().string());   // never taken for a temporary: it may be all there is
  if (flag_unsupported() && ::rename(to.c_str(), old.c_str()) == 0) {
    if (::rename(from.c_str(), to.c_str()) == 0 && ::rename(old.c_str(), from.c_str()) == 0) return;
    const int error = errno;
    if (!fs::exists(to)) ::rename(old.c_str(), to.c_str());
    errno = error;
  }
  throw IoError(to, cause("cannot be replaced"));
}

void check_file_target(const fs::path& target, Overwrite overwrite) {
  if (!fs::exists(target)) return;
  if (!fs::is_regular_file(target)) throw IoError(target, "is not a regular file; choose another output name");
  if (overwrite == Overwrite::refuse) refuse_existing(target);
}

void check_directory_target(const fs::path& target, Overwrite overwrite, const std::string& marker_file) {
  if (!fs::exists(target)) return;
  if (!fs::is_directory(target)) throw IoError(target, "exists and is not a directory; choose another output name");
  if (overwrite == Overwrite::refuse) refuse_existing(target);
  if (!fs::is_empty(target) && !fs::exists(target / marker_file))
    throw IoError(target, "is not replaced: it holds other files and no " + marker_file + "; choose another output name");
}

}  // namespace

AtomicFile::AtomicFile(fs::path target, Overwrite overwrite) : target_(resolved(target)), overwrite_(overwrite) {
  check_file_target(target_, overwrite_);
  create_parent(target_);
  temporary_ = std::make_unique<TemporaryOutput>(TemporaryOutput::Kind::file, target_, target_.parent_path());
  PendingOutputs::instance().add(temporary_path());
}

const fs::path& AtomicFile::temporary_path() const { return temporary_->path(); }
const fs::path& AtomicDirectory::temporary_path() const { return temporary_->path(); }

AtomicFile::~AtomicFile() {
  if (!committed_) PendingOutputs::instance().discard(temporary_path());
}

void AtomicFile::commit() {
  sync_or_throw(temporary_path(), target_, ::fsync);
  PendingOutputs::instance().publish(temporary_path(), [this] {
    if (overwrite_ == Overwrite::refuse) return rename_to_new_name(temporary_path(), target_);
    if (::rename(temporary_path().c_str(), target_.c_str()) != 0) throw IoError(target_, cause("cannot be put in place"));
  });
  committed_ = true;
  sync_parent(target_);
}

AtomicDirectory::AtomicDirectory(fs::path target, Overwrite overwrite, std::string marker_file, Workplace workplace)
    : target_(resolved(target)), overwrite_(overwrite), marker_file_(std::move(marker_file)) {
  check_directory_target(target_, overwrite_, marker_file_);
  create_parent(target_);
  fs::path folder = target_.parent_path();
  if (workplace == Workplace::own_folder) {
    folder /= "." + target_.filename().string() + ".unfinished";
    if (::mkdir(folder.c_str(), 0777) != 0 && errno != EEXIST) throw IoError(target_, cause("cannot be created"));
  }
  temporary_ = std::make_unique<TemporaryOutput>(TemporaryOutput::Kind::directory, target_, folder);
  PendingOutputs::instance().add(temporary_path());
}

AtomicDirectory::~AtomicDirectory() {
  if (!committed_) PendingOutputs::instance().discard(temporary_path());
}

void AtomicDirectory::commit() {
  // One call for the whole file system: a prior has thousands of tiles, and an fsync for each takes minutes.
  sync_or_throw(temporary_path(), target_, ::syncfs);
  check_directory_target(target_, overwrite_, marker_file_);
  const bool replaces = fs::exists(target_);
  PendingOutputs::instance().publish(temporary_path(), [&] {
    replaces ? exchange_directories(temporary_path(), target_) : rename_to_new_name(temporary_path(), target_);
  });
  committed_ = true;
  sync_parent(target_);
  if (replaces) PendingOutputs::instance().discard(temporary_path());
}

}  // namespace priormap
