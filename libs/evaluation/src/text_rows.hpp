#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace priormap {

/// One line of a text file, with its number for messages.
struct TextRow {
  std::size_t line = 0;
  std::string_view text;
};

/// The whole file. @throws IoError
std::string read_text(const std::filesystem::path& file);

/// Its lines without empty ones and comments (#).
std::vector<TextRow> text_rows(std::string_view text);

/// Fields between commas (possibly empty), or, where `separator` is a blank, between runs of blanks and tabs.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The whole field as a number; nothing else than the number and blanks around it.
std::optional<double> number(std::string_view field);

}  // namespace priormap
