#pragma once
#include <filesystem>
#include <functional>
#include <osmium/io/file.hpp>
#include <string>

namespace priormap {

/// An OSM file as libosmium reads it: the file itself, or a nameless temporary copy: in UTF-8, where XML is declared in an encoding that
/// its parser does not know; without padding, where zero bytes follow what bzip2 packed.
class OsmInput {
 public:
  /// @throws IoError; FormatError for an encoding that is none of one byte a character, and for what unpacks to far more than a map
  explicit OsmInput(const std::filesystem::path& file);
  ~OsmInput();
  OsmInput(OsmInput&& other) noexcept;
  OsmInput& operator=(OsmInput&&) = delete;

  osmium::io::File file() const;

 private:
  std::filesystem::path path_;
  void keep_copy(const std::string& format, const std::function<void(int descriptor)>& write);

  int copy_ = -1;   ///< descriptor
  std::string copy_format_;
};

}  // namespace priormap
