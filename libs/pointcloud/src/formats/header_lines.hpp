#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace priormap {

/// The text lines at the start of a file, split into words, up to and with the line whose first word is `last`.
struct HeaderLines {
  std::vector<std::vector<std::string>> lines;
  std::uint64_t size = 0;       ///< bytes of the header
  std::uint64_t file_size = 0;
};

/// @throws FormatError when that line is not within the first 64 KB, IoError
HeaderLines read_header_lines(const std::filesystem::path& file, const std::string& last);

/// @throws FormatError when the text is no whole number.
std::uint64_t whole_number(const std::string& text, const std::filesystem::path& file);

}  // namespace priormap
