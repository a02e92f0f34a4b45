#include "toml.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include <priormap/core/error.hpp>

namespace priormap::cli {
namespace {

void append_utf8(std::string& out, std::uint32_t code) {
  const auto tail = [&](int shift) { out += static_cast<char>(0x80 | ((code >> shift) & 0x3F)); };
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0 | (code >> 6));
    tail(0);
  } else if (code < 0x10000) {
    out += static_cast<char>(0xE0 | (code >> 12));
    tail(6), tail(0);
  } else {
    out += static_cast<char>(0xF0 | (code >> 18));
    tail(12), tail(6), tail(0);
  }
}

bool is_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text) {}

  std::vector<TomlEntry> parse() {
    std::vector<TomlEntry> entries;
    for (skip_blank(true); !at_end(); skip_blank(true)) {
      entries.push_back(entry());
      const auto same_key = [&](const TomlEntry& earlier) { return earlier.key == entries.back().key; };
      if (std::any_of(entries.begin(), entries.end() - 1, same_key)) fail("'" + entries.back().key + "' is set twice");
      skip_blank(false);
      if (!at_end() && peek() != '\n') fail("unexpected text after the value");
    }
    return entries;
  }

 private:
  TomlEntry entry() {
    if (peek() == '[') fail("sections are not used here: write KEY = VALUE");
    TomlEntry result;
    result.line = line_;
    result.key = peek() == '"' || peek() == '\'' ? quoted() : bare();
    skip_blank(false);
    if (at_end() || peek() != '=') fail("expected KEY = VALUE");
    ++position_;
    skip_blank(false);
    if (!at_end() && peek() == '[')
      result.values = array();
    else
      result.values = {scalar()};
    return result;
  }

  std::string bare() {
    const std::size_t start = position_;
    while (!at_end() && is_bare(peek())) ++position_;
    if (position_ == start) fail("expected KEY = VALUE");
    return text_.substr(start, position_ - start);
  }

  std::vector<std::string> array() {
    std::vector<std::string> values;
    ++position_;
    for (skip_blank(true);; skip_blank(true)) {
      if (at_end()) fail("array without end");
      if (peek() == ']') break;
      values.push_back(scalar());
      skip_blank(true);
      if (!at_end() && peek() == ',')
        ++position_;
      else if (at_end() || peek() != ']')
        fail("expected , or ] in the array");
    }
    ++position_;
    return values;
  }

  std::string scalar() {
    if (at_end() || peek() == '\n' || peek() == '#') fail("value missing");
    if (peek() == '"' || peek() == '\'') return quoted();
    const std::size_t start = position_;
    while (!at_end() && (is_bare(peek()) || peek() == '.' || peek() == '+' || peek() == ':')) ++position_;
    const std::string word = text_.substr(start, position_ - start);
    const bool number = !word.empty() && (std::isdigit(static_cast<unsigned char>(word.front())) || word.front() == '-' ||
                                          word.front() == '+' || word == "inf" || word == "nan");
    if (!number && word != "true" && word != "false") fail("text values need quotes");
    std::string digits;
    std::copy_if(word.begin(), word.end(), std::back_inserter(digits), [](char c) { return c != '_' && c != '+'; });
    return number ? digits : word;
  }

  std::string quoted() {
    const char quote = text_[position_++];
    std::string out;
    for (;;) {
      if (at_end() || peek() == '\n') fail("string without end");
      const char c = text_[position_++];
      if (c == quote) return out;
      if (c == '\\' && quote == '"')
        escape(out);
      else
        out += c;
    }
  }

  void escape(std::string& out) {
    if (at_end()) fail("string without end");
    const char c = text_[position_++];
    const std::string from = "btnfr\"\\", to = "\b\t\n\f\r\"\\";
    if (const auto known = from.find(c); known != std::string::npos)
      out += to[known];
    else if (c == 'u' || c == 'U')
      append_utf8(out, code_point(c == 'u' ? 4 : 8));
    else
      fail(std::string("unknown escape \\") + c);
  }

  std::uint32_t code_point(std::size_t digits) {
    const std::string hex = text_.substr(position_, digits);
    std::uint32_t code = 0;
    const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), code, 16);
    if (hex.size() != digits || error != std::errc() || end != hex.data() + digits || code > 0x10FFFF) fail("bad \\u escape");
    position_ += digits;
    return code;
  }

  void skip_blank(bool lines) {
    while (!at_end()) {
      if (peek() == '#') {
        while (!at_end() && peek() != '\n') ++position_;
      } else if (peek() == '\n' && lines) {
        ++line_, ++position_;
      } else if (peek() == ' ' || peek() == '\t' || peek() == '\r') {
        ++position_;
      } else {
        return;
      }
    }
  }

  bool at_end() const { return position_ >= text_.size(); }
  char peek() const { return text_[position_]; }
  [[noreturn]] void fail(const std::string& cause) const { throw UsageError("line " + std::to_string(line_) + ": " + cause); }

  const std::string& text_;
  std::size_t position_ = 0;
  int line_ = 1;
};

}  // namespace

std::vector<TomlEntry> parse_toml(const std::string& text) { return Parser(text).parse(); }

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (code < 0x20 || code == 0x7F) {
      out += std::string("\\u00") + "0123456789ABCDEF"[code >> 4] + "0123456789ABCDEF"[code & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

}  // namespace priormap::cli
