#pragma once
#include <zlib.h>

#include <filesystem>
#include <memory>
#include <span>

namespace priormap {

/// Bytes of a plain or gzip-compressed file, in order.
class ByteSource {
 public:
  /// @throws IoError
  explicit ByteSource(const std::filesystem::path& file);
  /// Fills `buffer`; fewer bytes only at the end. @throws FormatError on a damaged gzip stream
  std::size_t read(std::span<char> buffer);

 private:
  struct Close { void operator()(gzFile file) const { gzclose(file); } };
  std::filesystem::path path_;
  std::unique_ptr<gzFile_s, Close> file_;
};

}  // namespace priormap
