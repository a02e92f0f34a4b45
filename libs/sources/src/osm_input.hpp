#pragma once
#include <filesystem>
#include <osmium/io/file.hpp>

namespace priormap {

/// An OSM file as libosmium reads it: the file itself, or, where XML is declared in an encoding that its parser does not know, a nameless temporary copy in UTF-8.
class OsmInput {
 public:
  /// @throws IoError; FormatError for an encoding that is none of one byte a character
  explicit OsmInput(const std::filesystem::path& file);
  ~OsmInput();
  OsmInput(OsmInput&& other) noexcept;
  OsmInput& operator=(OsmInput&&) = delete;

  osmium::io::File file() const;

 private:
  std::filesystem::path path_;
  int copy_ = -1;   ///< descriptor
};

}  // namespace priormap
