#include "option_value.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include <priormap/core/error.hpp>

namespace priormap::cli {
namespace {

template <class Number>
Number parse_whole(const std::string& text, const char* what) {
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  Number value{};
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || begin == end) throw UsageError("'" + text + "' is not " + what);
  return value;
}

std::string with_unit(double value, const OptionField& field) {
  return number_text(value) + (field.unit.empty() ? "" : " " + std::string(field.unit));
}

void check_range(double value, const OptionField& field, const std::string& text) {
  if (value >= field.min && value <= field.max) return;
  if (std::isinf(field.max)) throw UsageError(text + " is below " + with_unit(field.min, field));
  if (std::isinf(field.min)) throw UsageError(text + " is above " + with_unit(field.max, field));
  throw UsageError(text + " is outside " + number_text(field.min) + " to " + with_unit(field.max, field));
}

}  // namespace

double parse_number(const std::string& text, const OptionField& field) {
  const double value = parse_whole<double>(text, "a number");
  if (!std::isfinite(value)) throw UsageError("'" + text + "' is not a finite number");
  check_range(value, field, text);
  return value;
}

std::int64_t parse_integer(const std::string& text, const OptionField& field) {
  const auto value = parse_whole<std::int64_t>(text, "a whole number");
  check_range(static_cast<double>(value), field, text);
  return value;
}

std::uint64_t parse_unsigned(const std::string& text, const OptionField& field) {
  const auto value = parse_whole<std::uint64_t>(text, "a whole number of 0 or more");
  check_range(static_cast<double>(value), field, text);
  return value;
}

std::vector<double> parse_number_list(const std::vector<std::string>& texts, const OptionField& field) {
  std::vector<double> values;
  for (const std::string& text : texts)
    for (std::size_t start = 0; start <= text.size();) {
      const std::size_t comma = std::min(text.find(',', start), text.size());
      const std::string between_commas = text.substr(start, comma - start);
      std::istringstream words(between_commas);
      std::string word;
      if (!(words >> word)) parse_number(between_commas, field);   // refuses
      do values.push_back(parse_number(word, field));
      while (words >> word);
      start = comma + 1;
    }
  return values;
}

std::string number_text(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace priormap::cli
