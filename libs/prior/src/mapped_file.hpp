#pragma once
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <span>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <priormap/core/error.hpp>

namespace priormap {

/// A whole file, read-only in memory.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) throw IoError(file, std::string("cannot be read: ") + std::strerror(errno));
    struct stat status {};
    ::fstat(descriptor, &status);
    size_ = S_ISREG(status.st_mode) ? std::size_t(status.st_size) : 0;
    if (size_ != 0) data_ = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, descriptor, 0);
    ::close(descriptor);
    if (data_ == MAP_FAILED) throw IoError(file, std::string("cannot be mapped: ") + std::strerror(errno));
  }
  ~MappedFile() {
    if (data_ != nullptr) ::munmap(data_, size_);
  }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(data_), size_}; }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace priormap
