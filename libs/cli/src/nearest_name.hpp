#pragma once
#include <optional>
#include <string>
#include <vector>

namespace priormap::cli {

/// The name that was probably meant: the one that takes the fewest slips of the keyboard (a letter too many, too few, wrong, or two exchanged), at most one in three
/// letters; else the shortest that begins as `written` does. Of equal ones the first.
std::optional<std::string> nearest_name(const std::string& written, const std::vector<std::string>& names);

/// "; did you mean NAME?", or nothing where none is near.
std::string meant(const std::string& written, const std::vector<std::string>& names, const std::string& prefix = "");

}  // namespace priormap::cli
