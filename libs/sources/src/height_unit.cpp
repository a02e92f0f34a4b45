#include "height_unit.hpp"

#include <algorithm>
#include <cctype>
#include <unordered_map>

namespace priormap {
namespace {

/// Letters in lower case and nothing else, without a plural s.
std::string plain(const std::string& name) {
  std::string text;
  for (const char c : name)
    if (std::isalpha(static_cast<unsigned char>(c))) text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::size_t shortest_word = 4;   // "ftus" is none
  if (text.size() > shortest_word && text.ends_with('s')) text.pop_back();
  if (text.ends_with("meter")) text.replace(text.size() - 2, 2, "re");
  return text;
}

}  // namespace

std::optional<double> length_unit_m(const std::string& name) {
  constexpr double foot = 0.3048, us_foot = 1200.0 / 3937;
  static const std::unordered_map<std::string, double> units = {
      {"m", 1},        {"metre", 1},        {"mm", 0.001},  {"millimetre", 0.001}, {"cm", 0.01},       {"centimetre", 0.01},     {"dm", 0.1},           {"decimetre", 0.1},
      {"km", 1000},    {"kilometre", 1000}, {"ft", foot},   {"foot", foot},        {"feet", foot},     {"internationalfoot", foot}, {"internationalfeet", foot},
      {"usft", us_foot}, {"ftus", us_foot}, {"sfoot", us_foot}, {"surveyfoot", us_foot}, {"ussurveyfoot", us_foot}, {"ussurveyfeet", us_foot}, {"footu", us_foot},
      {"in", 0.0254},  {"inch", 0.0254},    {"yd", 0.9144}, {"yard", 0.9144},      {"fath", 1.8288},   {"fathom", 1.8288},
  };
  const auto found = units.find(plain(name));
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace priormap
