#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace priormap {

/// Bytes of a plain file, or of one compressed by gzip or bzip2 (whatever its name), in order.
class ByteSource {
 public:
  /// @throws IoError
  explicit ByteSource(const std::filesystem::path& file);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  /// Fills `buffer`; fewer bytes only at the end. @throws FormatError on a damaged stream
  std::size_t read(std::span<char> buffer);

 private:
  struct Stream;
  struct GzipOrPlain;
  struct Bzip2;
  std::unique_ptr<Stream> stream_;
};

}  // namespace priormap
