#include "spill_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

int open_nameless(const std::filesystem::path& folder) {
  std::string name = (folder / "spill-XXXXXX").string();
  const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) throw IoError(folder, std::string("cannot hold temporary data: ") + std::strerror(errno));
  ::unlink(name.c_str());
  return descriptor;
}

}  // namespace

SpillFile::~SpillFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

SpillFile::Piece SpillFile::append(std::span<const std::byte> bytes) {
  Piece piece;
  {
    const std::lock_guard lock(mutex_);
    if (descriptor_ < 0) descriptor_ = open_nameless(folder_);
    piece = {end_, bytes.size()};
    end_ += bytes.size();
  }
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, off_t(piece.offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw IoError(folder_, std::string("cannot write temporary data: ") + std::strerror(n == 0 ? ENOSPC : errno));
    done += std::size_t(n);
  }
  return piece;
}

void SpillFile::read(Piece piece, std::byte* target) const {
  for (std::size_t done = 0; done < piece.size;) {
    const ssize_t n = ::pread(descriptor_, target + done, piece.size - done, off_t(piece.offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw IoError(folder_, std::string("cannot read temporary data back: ") + std::strerror(n == 0 ? EIO : errno));
    done += std::size_t(n);
  }
}

}  // namespace priormap
