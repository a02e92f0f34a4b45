#include "text_rows.hpp"

#include <charconv>
#include <fstream>
#include <sstream>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

std::string read_text(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw IoError(file, "is a directory; a trajectory file is needed");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream) throw IoError(file, "cannot be read; does it exist?");
  if (stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (stream.bad()) throw IoError(file, "cannot be read");
  return std::move(text).str();
}

std::vector<TextRow> text_rows(std::string_view text) {
  std::vector<TextRow> rows;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    const std::string_view row = trimmed(text.substr(0, end));
    if (!row.empty() && row.front() != '#') rows.push_back({line, row});
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return rows;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> fields;
  if (separator == ',') {
    while (true) {
      const std::size_t end = text.find(',');
      fields.push_back(trimmed(text.substr(0, end)));
      if (end == std::string_view::npos) return fields;
      text.remove_prefix(end + 1);
    }
  }
  std::size_t begin = text.find_first_not_of(blanks);
  while (begin != std::string_view::npos) {
    const std::size_t end = text.find_first_of(blanks, begin);
    fields.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return fields;
}

std::optional<double> number(std::string_view field) {
  field = trimmed(field);
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

}  // namespace priormap
