#include "byte_source.hpp"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 18;

struct CloseFile { void operator()(std::FILE* file) const { std::fclose(file); } };
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

FileHandle open(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw IoError(file, "is a directory, not a file");
  FileHandle handle(std::fopen(file.c_str(), "rb"));
  if (!handle) throw IoError(file, std::string("cannot be opened: ") + std::strerror(errno));
  return handle;
}

bool is_bzip2(std::FILE* file) {
  std::array<char, 3> start{};
  const std::size_t n = std::fread(start.data(), 1, start.size(), file);
  return std::string_view(start.data(), n) == "BZh";
}

}  // namespace

struct ByteSource::Stream {
  explicit Stream(const std::filesystem::path& input) : path(input) {}
  virtual ~Stream() = default;
  virtual std::size_t read(std::span<char> buffer) = 0;
  std::optional<std::uintmax_t> padding_begins;
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

/// Streams may follow each other in one file, as parallel compressors write them.
struct ByteSource::Bzip2 : Stream {
  Bzip2(const std::filesystem::path& input, FileHandle handle) : Stream(input), file(std::move(handle)), packed(buffer_size) { std::rewind(file.get()); }
  ~Bzip2() override { end_stream(); }

  std::size_t read(std::span<char> buffer) override {
    state.next_out = buffer.data();
    state.avail_out = static_cast<unsigned>(buffer.size());
    while (state.avail_out > 0) {
      if (state.avail_in == 0) refill();
      if (state.avail_in == 0 && !in_stream) break;   // the end of the last stream
      if (!in_stream && num_streams > 0 && *state.next_in == 0) {
        pass_padding();
        break;
      }
      if (!in_stream) begin_stream();
      const bool starved = state.avail_in == 0;
      const unsigned room = state.avail_out;
      const int result = BZ2_bzDecompress(&state);
      if (result == BZ_STREAM_END) end_stream();
      else if (result != BZ_OK) throw FormatError(path, "the bzip2 stream is damaged");
      else if (starved && state.avail_out == room) throw FormatError(path, "the bzip2 stream is cut short");
    }
    return buffer.size() - state.avail_out;
  }

  void refill() {
    state.next_in = packed.data();
    state.avail_in = static_cast<unsigned>(std::fread(packed.data(), 1, packed.size(), file.get()));
    num_packed += state.avail_in;
    if (std::ferror(file.get())) throw IoError(path, "cannot be read");
  }
  void pass_padding() {
    padding_begins = num_packed - state.avail_in;
    for (; state.avail_in > 0; refill())
      if (std::any_of(state.next_in, state.next_in + state.avail_in, [](char c) { return c != 0; })) throw FormatError(path, "the bzip2 stream is damaged");
  }
  void begin_stream() {
    ++num_streams;
    if (BZ2_bzDecompressInit(&state, 0, 0) != BZ_OK) throw Error(path.string() + ": no memory to decompress it");
    in_stream = true;
  }
  void end_stream() {
    if (in_stream) BZ2_bzDecompressEnd(&state);
    in_stream = false;
  }

  FileHandle file;
  std::vector<char> packed;
  bz_stream state{};
  bool in_stream = false;
  std::uintmax_t num_packed = 0, num_streams = 0;
};

ByteSource::ByteSource(const std::filesystem::path& file) {
  FileHandle handle = open(file);
  if (is_bzip2(handle.get())) stream_ = std::make_unique<Bzip2>(file, std::move(handle));
  else stream_ = std::make_unique<GzipOrPlain>(file);
}

ByteSource::~ByteSource() = default;

std::size_t ByteSource::read(std::span<char> buffer) { return stream_->read(buffer); }

std::optional<std::uintmax_t> ByteSource::padding_begins() const { return stream_->padding_begins; }

}  // namespace priormap
