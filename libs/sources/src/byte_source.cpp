#include "byte_source.hpp"

#include <cerrno>
#include <cstring>

#include <priormap/core/error.hpp>

namespace priormap {

ByteSource::ByteSource(const std::filesystem::path& file) : path_(file) {
  if (std::filesystem::is_directory(file)) throw IoError(file, "is a directory, not a file");
  file_.reset(gzopen(file.c_str(), "rb"));
  if (!file_) throw IoError(file, std::string("cannot be opened: ") + std::strerror(errno));
  gzbuffer(file_.get(), 1 << 18);
}

std::size_t ByteSource::read(std::span<char> buffer) {
  std::size_t filled = 0;
  while (filled < buffer.size()) {
    const int n = gzread(file_.get(), buffer.data() + filled, static_cast<unsigned>(buffer.size() - filled));
    if (n < 0) throw FormatError(path_, "the gzip stream is damaged");
    if (n == 0) break;
    filled += static_cast<std::size_t>(n);
  }
  int state = Z_OK;
  gzerror(file_.get(), &state);
  if (filled < buffer.size() && state == Z_BUF_ERROR) throw FormatError(path_, "the gzip stream is cut short");
  return filled;
}

}  // namespace priormap
