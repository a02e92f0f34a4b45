#include "byte_source.hpp"

#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include <priormap/core/error.hpp>

#include "bzip2_stream.hpp"

namespace priormap {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 16;   // larger ones come fresh from the system each time, and cost more than they save

FileHandle open(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw IoError(file, "is a directory, not a file");
  FileHandle handle(std::fopen(file.c_str(), "rb"));
  if (!handle) throw IoError(file, std::string("cannot be opened: ") + std::strerror(errno));
  return handle;
}

bool is_bzip2(std::FILE* file) {
  std::array<char, 3> start{};
  const std::size_t n = std::fread(start.data(), 1, start.size(), file);
  std::rewind(file);
  return std::string_view(start.data(), n) == "BZh";
}

}  // namespace

struct ByteSource::Stream {
  explicit Stream(const std::filesystem::path& input) : path(input) {}
  virtual ~Stream() = default;
  virtual std::size_t read(std::span<char> buffer) = 0;
  const std::filesystem::path path;
};

struct ByteSource::GzipOrPlain : Stream {
  explicit GzipOrPlain(const std::filesystem::path& input) : Stream(input), file(gzopen(input.c_str(), "rb")) {
    if (!file) throw IoError(path, std::string("cannot be opened: ") + std::strerror(errno));
    gzbuffer(file.get(), buffer_size);
  }

  std::size_t read(std::span<char> buffer) override {
    std::size_t filled = 0;
    while (filled < buffer.size()) {
      const int n = gzread(file.get(), buffer.data() + filled, static_cast<unsigned>(buffer.size() - filled));
      if (n < 0) throw FormatError(path, "the gzip stream is damaged");
      if (n == 0) break;
      filled += static_cast<std::size_t>(n);
    }
    int state = Z_OK;
    gzerror(file.get(), &state);
    if (filled < buffer.size() && state == Z_BUF_ERROR) throw FormatError(path, "the gzip stream is cut short");
    return filled;
  }

  struct Close { void operator()(gzFile file) const { gzclose(file); } };
  std::unique_ptr<gzFile_s, Close> file;
};

struct ByteSource::Bzip2 : Stream {
  Bzip2(const std::filesystem::path& input, FileHandle handle) : Stream(input), stream(std::move(handle)) {}

  std::size_t read(std::span<char> buffer) override {
    try {
      return stream.read(buffer);
    } catch (const Bzip2Fault& fault) {
      throw FormatError(path, fault.what());
    } catch (const std::system_error& error) {
      throw IoError(path, "cannot be read: " + error.code().message());
    }
  }

  Bzip2Stream stream;
};

ByteSource::ByteSource(const std::filesystem::path& file) {
  FileHandle handle = open(file);
  if (is_bzip2(handle.get())) stream_ = std::make_unique<Bzip2>(file, std::move(handle));
  else stream_ = std::make_unique<GzipOrPlain>(file);
}

ByteSource::~ByteSource() = default;

std::size_t ByteSource::read(std::span<char> buffer) { return stream_->read(buffer); }

}  // namespace priormap
