#include "temporary_output.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>

namespace priormap {
namespace fs = std::filesystem;
namespace {

/// With a mark of this host: locks are not always seen by others that share a folder.
const std::string& prefix() {
  static const std::string text = [] {
    std::array<char, 256> host{};
    ::gethostname(host.data(), host.size() - 1);
    Sha256 hash;
    hash.update(std::string(host.data()));
    return ".tmp-" + hash.hex_digest().substr(0, 8) + "-";
  }();
  return text;
}

bool make(TemporaryOutput::Kind kind, const fs::path& path) {
  if (kind == TemporaryOutput::Kind::directory) return ::mkdir(path.c_str(), 0777) == 0;
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  return descriptor >= 0 && ::close(descriptor) == 0;
}

enum class Lock { held, of_another, gone, impossible };

/// Held only if the path still leads to what was locked.
Lock try_lock(const fs::path& path, int& descriptor) {
  descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return errno == ENOENT ? Lock::gone : Lock::impossible;
  struct stat locked{}, named{};
  Lock result = Lock::held;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0)
    result = errno == EWOULDBLOCK ? Lock::of_another : Lock::impossible;
  else if (::fstat(descriptor, &locked) != 0 || ::lstat(path.c_str(), &named) != 0 || locked.st_ino != named.st_ino || locked.st_dev != named.st_dev)
    result = Lock::gone;
  if (result != Lock::held) {
    ::close(descriptor);
    descriptor = -1;
  }
  return result;
}

/// PID-N-NAME after the prefix.
bool is_temporary_of(const std::string& entry, const std::string& name) {
  const std::string tail = "-" + name;
  if (!entry.starts_with(prefix()) || !entry.ends_with(tail)) return false;
  const std::size_t begin = prefix().size(), end = entry.size() - tail.size();
  if (end <= begin) return false;
  const std::string numbers = entry.substr(begin, end - begin);
  const std::size_t dash = numbers.find('-');
  const auto is_number = [](const std::string& text) { return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos; };
  return dash != std::string::npos && is_number(numbers.substr(0, dash)) && is_number(numbers.substr(dash + 1));
}

std::vector<std::string> temporaries_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (std::string name = entry->path().filename().string(); name.starts_with(prefix())) names.push_back(std::move(name));
  return names;
}

/// A folder is listed once: lookups and maps put thousands of outputs into one.
std::vector<std::string> left_in(const fs::path& folder, const std::string& name) {
  static std::mutex mutex;
  static std::map<fs::path, std::vector<std::string>> listed;
  const std::lock_guard lock(mutex);
  const auto [found, is_new] = listed.try_emplace(folder);
  if (is_new) found->second = temporaries_in(folder);
  std::vector<std::string> left;
  std::erase_if(found->second, [&](const std::string& entry) {
    if (!is_temporary_of(entry, name)) return false;
    left.push_back(entry);
    return true;
  });
  return left;
}

void remove_abandoned(const fs::path& folder, const std::string& name) {
  for (const std::string& entry : left_in(folder, name)) {
    int lock = -1;
    if (try_lock(folder / entry, lock) != Lock::held) continue;
    std::error_code error;   // what cannot be removed is in nobody's way
    fs::remove_all(folder / entry, error);
    ::close(lock);
  }
}

}  // namespace

TemporaryOutput::TemporaryOutput(Kind kind, const fs::path& target, const fs::path& folder) {
  static std::atomic<unsigned> serial = 0;
  const std::string name = target.filename().string();
  remove_abandoned(folder, name);
  for (;;) {
    path_ = folder / (prefix() + std::to_string(::getpid()) + "-" + std::to_string(serial++) + "-" + name);   // with the extension, by which some writers choose their format
    if (make(kind, path_)) {
      // Until it is locked another program may take it for abandoned.
      const Lock lock = try_lock(path_, lock_);
      if (lock == Lock::held || lock == Lock::impossible) return;
    } else if (errno != EEXIST) {
      throw IoError(target, std::string("cannot be created: ") + std::strerror(errno));
    }
  }
}

TemporaryOutput::~TemporaryOutput() {
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace priormap
