#include "data_license.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <sstream>
#include <string_view>

namespace priormap {
namespace {

/// Of the SPDX licence list, https://spdx.org/licenses: those made or in use for data. Creative Commons by its pattern.
constexpr std::array<std::string_view, 29> names = {
    "ODbL-1.0", "ODC-By-1.0", "PDDL-1.0", "CC0-1.0", "CC-PDDC", "CC-PDM-1.0", "CDLA-Permissive-1.0", "CDLA-Permissive-2.0", "CDLA-Sharing-1.0", "C-UDA-1.0", "O-UDA-1.0",
    "DL-DE-BY-2.0", "DL-DE-ZERO-2.0", "OGL-UK-1.0", "OGL-UK-2.0", "OGL-UK-3.0", "OGL-Canada-2.0", "OGDL-Taiwan-1.0", "etalab-2.0", "NLOD-1.0", "NLOD-2.0", "EUPL-1.2", "GFDL-1.3-only",
    "GFDL-1.3-or-later", "Apache-2.0", "MIT", "BSD-2-Clause", "BSD-3-Clause", "Unlicense"};

bool equal_but_for_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, [](unsigned char c) { return std::tolower(c); }, [](unsigned char c) { return std::tolower(c); });
}

bool is_known(const std::string& name) {
  static const std::regex others("CC-BY(-NC)?(-ND|-SA)?-[1-4]\\.[015](-[A-Z]{2,3})?|(DocumentRef-[A-Za-z0-9.-]+:)?LicenseRef-[A-Za-z0-9.-]+");
  return std::ranges::find(names, name) != names.end() || std::regex_match(name, others);
}

}  // namespace

std::optional<std::string> license_doubt(const std::string& license) {
  std::string spaced = license;
  std::ranges::replace_if(spaced, [](char c) { return c == '(' || c == ')'; }, ' ');
  std::istringstream words(spaced);
  for (std::string word; words >> word;) {
    if (word == "AND" || word == "OR" || is_known(word)) continue;
    const auto similar = std::ranges::find_if(names, [&](std::string_view name) { return equal_but_for_case(name, word); });
    const std::string remedy = similar != names.end() ? std::string(*similar) + " is one" : "such as ODbL-1.0, CC-BY-4.0 or DL-DE-BY-2.0; LicenseRef-NAME is for those without (https://spdx.org/licenses)";
    return "--license '" + license + "' is written as it is, but '" + word + "' is no SPDX identifier known for data: " + remedy;
  }
  return std::nullopt;
}

}  // namespace priormap
