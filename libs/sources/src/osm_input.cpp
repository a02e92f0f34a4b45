#include "osm_input.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <cstdio>
#include <osmium/io/compression.hpp>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/core/spill_file.hpp>

#include "byte_source.hpp"
#include "bzip2_stream.hpp"
#include "xml_encoding.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

int nameless_file() {
  const fs::path folder = SpillFile::temporary_folder();
  std::string name = folder / "priormap-XXXXXX";
  const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) throw IoError(folder, std::string("no temporary file can be made: ") + std::strerror(errno));
  ::unlink(name.c_str());
  return descriptor;
}

std::string utf8(int code_point) {
  const auto byte = [](int bits) { return static_cast<char>(bits); };
  if (code_point < 0x80) return {byte(code_point)};
  if (code_point < 0x800) return {byte(0xc0 | code_point >> 6), byte(0x80 | (code_point & 0x3f))};
  return {byte(0xe0 | code_point >> 12), byte(0x80 | (code_point >> 6 & 0x3f)), byte(0x80 | (code_point & 0x3f))};
}

void write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(descriptor, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw IoError(SpillFile::temporary_folder(), std::string("a temporary file cannot be written: ") + std::strerror(errno));
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// The declaration goes: without one XML is UTF-8.
void copy_as_utf8(const fs::path& file, const SingleByteTable& table, int descriptor) {
  std::array<std::string, 256> utf8_of;
  for (std::size_t i = 0; i < 256; ++i) utf8_of[i] = utf8(table[i] < 0 ? 0xfffd : table[i]);
  ByteSource bytes(file);
  std::vector<char> chunk(std::size_t(1) << 16);
  std::string out;
  // bzip2 packs maps to a tenth of their size or so, and emptiness to a millionth: that would fill the folder.
  constexpr std::uintmax_t most_per_packed = 100, always_allowed = std::uintmax_t{64} << 20;
  const std::uintmax_t most = std::max(always_allowed, most_per_packed * fs::file_size(file));
  std::uintmax_t unpacked = 0;
  bool in_declaration = true;
  for (std::size_t n = chunk.size(); n == chunk.size();) {
    n = bytes.read(chunk);
    if ((unpacked += n) > most) throw FormatError(file, "unpacks to more than " + std::to_string(most_per_packed) + " times its size, as no map does; if it is one, unpack it first");
    std::string_view text(chunk.data(), n);
    if (in_declaration) text.remove_prefix(std::min(text.size(), text.find('>') + 1));
    in_declaration = false;
    out.clear();
    for (const char c : text) out += utf8_of[static_cast<unsigned char>(c)];
    write_all(descriptor, out);
  }
}

/// Instead of libosmium's own, which ends with the stream that ends in the last 5000 bytes of a file, and takes zero bytes after the last stream for another.
class Bzip2Decompressor : public osmium::io::Decompressor {
 public:
  explicit Bzip2Decompressor(FileHandle file) : stream_(std::move(file)) {}
  std::string read() override {
    std::string buffer(std::size_t(1) << 16, '\0');
    buffer.resize(stream_.read(buffer));
    return buffer;
  }
  void close() override {}

 private:
  Bzip2Stream stream_;
};

void let_libosmium_read_bzip2() {
  using osmium::io::Compressor, osmium::io::Decompressor;
  static const bool registered = osmium::io::CompressionFactory::instance().register_compression(
      osmium::io::file_compression::bzip2, [](int, osmium::io::fsync) -> Compressor* { throw osmium::unsupported_file_format_error("bzip2 is only read"); },
      [](int descriptor) -> Decompressor* {
        FileHandle file(::fdopen(descriptor, "rb"));
        if (!file) throw std::system_error(errno, std::generic_category());
        return new Bzip2Decompressor(std::move(file));
      },
      [](const char*, std::size_t) -> Decompressor* { throw osmium::unsupported_file_format_error("bzip2 is only read from files"); });
  // libosmium keeps what came first: its own, where a file of the program includes that.
  if (!registered) throw std::logic_error("libosmium has another bzip2 decompressor already");
}

std::string start_of(const fs::path& file) {
  std::string start(4096, '\0');   // longer than any declaration
  start.resize(ByteSource(file).read(start));
  return start;
}

}  // namespace

OsmInput::OsmInput(const fs::path& file) : path_(file) {
  let_libosmium_read_bzip2();
  const std::string start = start_of(file);
  if (start.empty()) throw FormatError(file, "is empty; fetch it again");
  if (osmium::io::File(file.string()).format() != osmium::io::file_format::xml) return;
  const std::string encoding = foreign_xml_encoding(start);
  if (encoding.empty()) return;
  const std::optional<SingleByteTable> table = single_byte_table(encoding);
  if (!table) throw FormatError(file, encoding_fault(encoding));
  copy_ = nameless_file();
  try {
    copy_as_utf8(file, *table, copy_);
  } catch (...) {
    ::close(copy_);
    throw;
  }
}

OsmInput::OsmInput(OsmInput&& other) noexcept : path_(std::move(other.path_)), copy_(std::exchange(other.copy_, -1)) {}

OsmInput::~OsmInput() {
  if (copy_ >= 0) ::close(copy_);
}

osmium::io::File OsmInput::file() const {
  return copy_ < 0 ? osmium::io::File(path_.string()) : osmium::io::File("/proc/self/fd/" + std::to_string(copy_), "osm");
}

}  // namespace priormap
