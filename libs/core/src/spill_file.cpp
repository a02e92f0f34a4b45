#include <priormap/core/spill_file.hpp>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

#include <priormap/core/error.hpp>

namespace priormap {

SpillFile::~SpillFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::filesystem::path SpillFile::temporary_folder() {
  if (const char* named = std::getenv("TMPDIR"); named && *named) return named;
  std::error_code error;
  if (std::filesystem::is_directory("/var/tmp", error)) return "/var/tmp";   // on disk, where /tmp often is memory
  return std::filesystem::temp_directory_path();
}

void SpillFile::open() {
  std::string name = (folder_ / "spill-XXXXXX").string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) throw IoError(folder_, std::string("cannot hold temporary data: ") + std::strerror(errno));
  ::unlink(name.c_str());
}

void SpillFile::write(std::span<const std::byte> bytes, std::uint64_t offset) const {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, off_t(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw IoError(folder_, std::string("cannot write temporary data: ") + std::strerror(n == 0 ? ENOSPC : errno));
    done += std::size_t(n);
  }
}

SpillFile::Piece SpillFile::append(std::span<const std::byte> bytes) {
  std::unique_lock lock(mutex_);
  const Piece piece{written_ + buffer_.size(), bytes.size()};
  if (buffer_.size() + bytes.size() <= memory_bytes_) {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    return piece;
  }
  if (descriptor_ < 0) open();
  write(buffer_, written_);
  written_ = piece.offset;
  buffer_.clear();
  if (bytes.size() <= memory_bytes_) {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    return piece;
  }
  written_ += bytes.size();
  lock.unlock();
  write(bytes, piece.offset);
  return piece;
}

void SpillFile::read(Piece piece, std::byte* target) const {
  if (memory_bytes_ > 0) {
    const std::lock_guard lock(mutex_);
    if (piece.offset >= written_) {
      std::memcpy(target, buffer_.data() + (piece.offset - written_), piece.size);
      return;
    }
  }
  for (std::size_t done = 0; done < piece.size;) {
    const ssize_t n = ::pread(descriptor_, target + done, piece.size - done, off_t(piece.offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw IoError(folder_, std::string("cannot read temporary data back: ") + std::strerror(n == 0 ? EIO : errno));
    done += std::size_t(n);
  }
}

std::vector<std::byte> SpillFile::read(Piece piece) const {
  std::vector<std::byte> bytes(piece.size);
  read(piece, bytes.data());
  return bytes;
}

}  // namespace priormap
