#include <priormap/core/spill_file.hpp>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

std::atomic<std::uint64_t> files_made = 0;

/// What a thread has read ahead, of the file it read last.
struct Window {
  std::uint64_t file = 0, offset = 0, end_of_last = 0;
  std::vector<std::byte> bytes;

  bool holds(SpillFile::Piece piece) const { return piece.offset >= offset && piece.offset + piece.size <= offset + bytes.size(); }
};

}  // namespace

SpillFile::SpillFile(std::filesystem::path folder, std::size_t memory_bytes) : folder_(std::move(folder)), memory_bytes_(memory_bytes), number_(++files_made) {}

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
  const std::lock_guard lock(mutex_);
  const Piece piece{written_ + buffer_.size(), bytes.size()};
  if (buffer_.size() + bytes.size() > memory_bytes_) {
    if (descriptor_ < 0) open();
    write(buffer_, written_);
    written_ = piece.offset;
    buffer_.clear();
  }
  if (bytes.size() <= memory_bytes_) {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  } else {
    write(bytes, piece.offset);
    written_ += bytes.size();
  }
  return piece;
}

void SpillFile::read(Piece piece, std::byte* target) const {
  constexpr std::size_t ahead = std::size_t(1) << 16;
  thread_local Window window;
  if (piece.size == 0) return;
  const bool same_file = window.file == number_, in_row = same_file && window.end_of_last == piece.offset;
  if (!same_file) window.bytes.clear();
  window.file = number_;
  window.end_of_last = piece.offset + piece.size;
  if (!window.holds(piece)) {
    std::unique_lock lock(mutex_);
    if (piece.offset >= written_) {
      std::memcpy(target, buffer_.data() + (piece.offset - written_), piece.size);
      return;
    }
    const std::uint64_t written = written_;
    lock.unlock();
    if (!in_row || piece.size > ahead) return read_file(piece.offset, {target, piece.size});
    window.offset = piece.offset;
    window.bytes.resize(std::min<std::uint64_t>(ahead, written - piece.offset));
    read_file(window.offset, window.bytes);
  }
  std::memcpy(target, window.bytes.data() + (piece.offset - window.offset), piece.size);
}

void SpillFile::read_file(std::uint64_t offset, std::span<std::byte> target) const {
  for (std::size_t done = 0; done < target.size();) {
    const ssize_t n = ::pread(descriptor_, target.data() + done, target.size() - done, off_t(offset + done));
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
