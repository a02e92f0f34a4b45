#include "osm_input.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/core/spill_file.hpp>

#include "byte_source.hpp"
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
  std::vector<char> chunk(std::size_t(1) << 20);
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

/// Whether a file's last eleven bytes are the end of a bzip2 stream: 48 bits that stand for it, 32 of a checksum, and up to 7 zeros to fill a byte.
bool ends_bzip2_stream(const std::array<unsigned char, 11>& last) {
  constexpr std::uint64_t end_of_stream = 0x177245385090, bits_48 = 0xffffffffffff;
  std::uint64_t before_checksum = 0;   // and as many bits again as the filling has
  for (std::size_t i = 0; i < 7; ++i) before_checksum = before_checksum << 8 | last[i];
  for (unsigned filling = 0; filling < 8; ++filling)
    if ((before_checksum >> filling & bits_48) == end_of_stream && (last.back() & ((1u << filling) - 1)) == 0) return true;
  return false;
}

/// libosmium takes whatever follows a stream of bzip2 for another one. Only a file that ends in zeros beyond its last stream is read as a whole.
std::optional<std::uintmax_t> end_before_padding(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 2> start{};
  std::array<char, 11> end{};
  if (!stream.read(start.data(), start.size()) || start != std::array{'B', 'Z'}) return std::nullopt;
  if (!stream.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end).read(end.data(), end.size()) || end.back() != 0) return std::nullopt;
  std::array<unsigned char, 11> bytes_at_end{};
  std::ranges::transform(end, bytes_at_end.begin(), [](char c) { return static_cast<unsigned char>(c); });
  if (ends_bzip2_stream(bytes_at_end)) return std::nullopt;
  ByteSource bytes(file);
  std::vector<char> chunk(std::size_t(1) << 18);
  while (bytes.read(chunk) == chunk.size()) {}
  return bytes.padding_begins();
}

void copy_start(const fs::path& file, std::uintmax_t size, int descriptor) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> chunk(std::size_t(1) << 18);
  while (size > 0 && stream.read(chunk.data(), static_cast<std::streamsize>(std::min<std::uintmax_t>(size, chunk.size())))) {
    write_all(descriptor, {chunk.data(), static_cast<std::size_t>(stream.gcount())});
    size -= static_cast<std::uintmax_t>(stream.gcount());
  }
  if (size > 0) throw IoError(file, "cannot be read");
}

}  // namespace

OsmInput::OsmInput(const fs::path& file) : path_(file) {
  if (osmium::io::File(file.string()).format() != osmium::io::file_format::xml) return;
  const std::string encoding = foreign_xml_encoding(file);
  if (encoding.empty()) {
    if (const auto end = end_before_padding(file)) keep_copy("osm.bz2", [&](int copy) { copy_start(file, *end, copy); });
    return;
  }
  const std::optional<SingleByteTable> table = single_byte_table(encoding);
  if (!table) throw FormatError(file, encoding_fault(encoding));
  keep_copy("osm", [&](int copy) { copy_as_utf8(file, *table, copy); });
}

void OsmInput::keep_copy(const std::string& format, const std::function<void(int descriptor)>& write) {
  copy_format_ = format;
  copy_ = nameless_file();
  try {
    write(copy_);
  } catch (...) {
    ::close(copy_);
    throw;
  }
}

OsmInput::OsmInput(OsmInput&& other) noexcept : path_(std::move(other.path_)), copy_(std::exchange(other.copy_, -1)), copy_format_(std::move(other.copy_format_)) {}

OsmInput::~OsmInput() {
  if (copy_ >= 0) ::close(copy_);
}

osmium::io::File OsmInput::file() const {
  return copy_ < 0 ? osmium::io::File(path_.string()) : osmium::io::File("/proc/self/fd/" + std::to_string(copy_), copy_format_);
}

}  // namespace priormap
