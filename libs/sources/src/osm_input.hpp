#pragma once
#include <filesystem>
#include <osmium/io/file.hpp>
// All that osmium/io/any_input.hpp names but bzip2, which OsmInput brings: where any file of a program includes that, osmium/io/any_compression.hpp or
// osmium/io/bzip2_compression.hpp, libosmium's own is registered first, and OsmInput refuses to work.
#include <osmium/io/gzip_compression.hpp>
#include <osmium/io/o5m_input.hpp>
#include <osmium/io/opl_input.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/xml_input.hpp>

namespace priormap {

/// An OSM file as libosmium reads it: the file itself, or a nameless temporary copy in UTF-8, where XML is declared in an encoding that its parser does not know.
class OsmInput {
 public:
  /// @throws IoError; FormatError for an empty file, for an encoding that is none of one byte a character, and for what unpacks to far more than a map
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
