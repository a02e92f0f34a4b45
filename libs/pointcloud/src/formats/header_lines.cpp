#include "formats/header_lines.hpp"

#include <algorithm>
#include <charconv>
#include <span>
#include <sstream>

#include <priormap/core/error.hpp>

#include "formats/read_only_file.hpp"

namespace priormap {
namespace {
constexpr std::size_t max_header_size = 1 << 16;
}

HeaderLines read_header_lines(const std::filesystem::path& file, const std::string& last) {
  const ReadOnlyFile input(file);
  std::string text(std::min<std::uint64_t>(input.size(), max_header_size), '\0');
  input.read(0, std::as_writable_bytes(std::span(text)));
  HeaderLines header;
  header.file_size = input.size();
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    std::istringstream line(text.substr(at, end - at));
    std::vector<std::string> words;
    for (std::string word; line >> word;) words.push_back(word);
    at = end + 1;
    if (words.empty()) continue;
    header.lines.push_back(std::move(words));
    if (header.lines.back()[0] == last) {
      header.size = at;
      return header;
    }
  }
  throw FormatError(file, "has no complete header: the line '" + last + "' is missing");
}

std::uint64_t whole_number(const std::string& text, const std::filesystem::path& file) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) throw FormatError(file, "has '" + text + "' in its header where a number is expected");
  return value;
}

}  // namespace priormap
