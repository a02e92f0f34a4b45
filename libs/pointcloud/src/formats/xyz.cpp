#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include <priormap/core/error.hpp>

#include "formats/named_columns.hpp"
#include "formats/point_format.hpp"
#include "formats/read_only_file.hpp"
#include "formats/text_rows.hpp"

// Text: one point a line, numbers apart by blanks, commas or semicolons. Columns are x, y, z and others without a name, unless the first
// line (or a comment there) names them. Lines that begin with # or // are comments.

namespace priormap {
namespace {

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r'; }

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while (at < line.size()) {
    while (at < line.size() && is_separator(line[at])) ++at;
    const std::size_t begin = at;
    while (at < line.size() && !is_separator(line[at])) ++at;
    if (at > begin) words.push_back(line.substr(begin, at - begin));
  }
  return words;
}

std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with("//"); }

/// Names of the columns where the line holds words such as "x y z intensity", quoted or not; else nothing.
std::vector<std::string> column_names(std::string_view line) {
  while (!line.empty() && (line.front() == '#' || line.front() == '/')) line.remove_prefix(1);
  std::vector<std::string> names;
  bool has_x = false;
  for (std::string_view word : split(line)) {
    if (word.size() > 2 && word.front() == '"' && word.back() == '"') word = word.substr(1, word.size() - 2);
    names.emplace_back(word);
    has_x |= word == "x" || word == "X";
  }
  return has_x ? names : std::vector<std::string>();
}

struct Table {
  std::vector<std::string> names;
  std::vector<double> values;  ///< row by row
  std::size_t width() const { return names.size(); }
};

Table parse(std::string_view text, const std::filesystem::path& file) {
  Table table;
  std::size_t line_number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    ++line_number;
    const auto fail = [&](const std::string& cause) -> FormatError {
      return FormatError(file, "line " + std::to_string(line_number) + " " + cause);
    };
    const auto words = split(line);
    if (words.empty()) continue;
    const bool may_name_columns = table.names.empty();
    if (is_comment(line) || (may_name_columns && !number(words[0]))) {
      if (may_name_columns) table.names = column_names(line);
      if (!is_comment(line) && table.names.empty()) throw fail("is no point: '" + std::string(words[0]) + "' is no number");
      continue;
    }
    if (table.names.empty()) {
      table.names = {"x", "y", "z"};
      if (words.size() == 4) table.names.push_back("intensity");  // the order of KITTI, and of every tool that writes four
    }
    if (words.size() < table.width())
      throw fail("holds " + std::to_string(words.size()) + " values instead of " + std::to_string(table.width()));
    for (std::size_t i = 0; i < table.width(); ++i) {
      const auto value = number(words[i]);
      if (!value) throw fail("is no point: '" + std::string(words[i]) + "' is no number");
      table.values.push_back(*value);
    }
  }
  return table;
}

}  // namespace

CloudFile read_xyz(const std::filesystem::path& file) {
  const ReadOnlyFile input(file);
  std::string text(input.size(), '\0');
  input.read(0, std::as_writable_bytes(std::span(text)));
  const Table table = parse(text, file);
  if (table.values.empty()) return {};

  std::vector<NamedColumn> columns;
  const auto* first = reinterpret_cast<const std::byte*>(table.values.data());
  for (std::size_t i = 0; i < table.width(); ++i)
    columns.push_back({table.names[i], ScalarType::float64, first + i * sizeof(double), table.width() * sizeof(double)});
  return {cloud_from_columns(columns, table.values.size() / table.width(), file), {}};
}

void write_xyz(std::ostream& out, const PointCloud& points, const CloudWriteOptions&) {
  const auto columns = columns_of_cloud(points);
  out << '#';
  for (const NamedColumn& column : columns) out << ' ' << column.name;
  out << '\n';
  write_text_rows(out, columns, points.size());
}

}  // namespace priormap
