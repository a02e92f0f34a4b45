#include "formats/text_rows.hpp"

#include <charconv>
#include <string>

namespace priormap {
namespace {

constexpr std::size_t block_bytes = 1 << 16;

void append_number(std::string& text, const NamedColumn& column, std::size_t i) {
  char digits[32];
  with_type(column.type, [&](auto example) {
    const auto value = load<decltype(example)>(column.first + i * column.stride);
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  });
}

}  // namespace

void write_text_rows(std::ostream& out, const std::vector<NamedColumn>& columns, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    for (const NamedColumn& column : columns) {
      append_number(text, column, i);
      text += &column == &columns.back() ? '\n' : ' ';
    }
    if (text.size() >= block_bytes) {
      out.write(text.data(), static_cast<std::streamsize>(text.size()));
      text.clear();
    }
  }
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
}

}  // namespace priormap
