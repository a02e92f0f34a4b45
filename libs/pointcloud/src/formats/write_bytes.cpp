#include "formats/write_bytes.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <priormap/core/error.hpp>

namespace priormap {

void write_bytes(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) throw IoError(file, std::string("cannot be created (") + std::strerror(errno) + ")");
  std::size_t done = 0;
  int error = 0;
  while (done < bytes.size() && error == 0) {
    const ssize_t put = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (put >= 0)
      done += static_cast<std::size_t>(put);
    else if (errno != EINTR)
      error = errno;
  }
  if (::close(descriptor) != 0 && error == 0) error = errno;  // NFS and quotas report a full disk here
  if (error != 0) throw IoError(file, std::string("cannot be written (") + std::strerror(error) + ")");
}

}  // namespace priormap
