#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <priormap/core/option_field.hpp>

namespace priormap::cli {

// Text to values and back. Numbers are read whole, without locale, finite, and within the field's range.
// All throw UsageError saying what was expected.
double parse_number(const std::string& text, const OptionField& field);
std::int64_t parse_integer(const std::string& text, const OptionField& field);
std::uint64_t parse_unsigned(const std::string& text, const OptionField& field);
/// Numbers parted by commas, white space or both.
std::vector<double> parse_number_list(const std::vector<std::string>& texts, const OptionField& field);

/// The shortest text that reads back as the same number.
std::string number_text(double value);

}  // namespace priormap::cli
