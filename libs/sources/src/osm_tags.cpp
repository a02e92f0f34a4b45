#include <priormap/sources/osm_tags.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

namespace priormap {
namespace {

constexpr double inch_m = 0.0254, foot_m = 0.3048;
constexpr double highest_building_m = 1000, most_storeys = 250;

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// Takes a non-negative decimal number, point or comma, off the front of the text.
std::optional<double> take_number(std::string_view& text) {
  std::array<char, 32> digits{};
  std::size_t n = 0;
  bool seen_digit = false, seen_point = false;
  for (; n < text.size() && n + 1 < digits.size(); ++n) {
    const char c = text[n];
    const bool point = c == '.' || c == ',';
    if (!(std::isdigit(static_cast<unsigned char>(c)) || (point && !seen_point))) break;
    seen_digit |= !point;
    seen_point |= point;
    digits[n] = point ? '.' : c;
  }
  if (!seen_digit) return std::nullopt;
  double value = 0;
  if (std::from_chars(digits.data(), digits.data() + n, value).ec != std::errc()) return std::nullopt;
  text.remove_prefix(n);
  return value;
}

bool take(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

bool take_foot_mark(std::string_view& text) { return take(text, "'") || take(text, "\u2032") || take(text, "\u2019"); }
bool take_inch_mark(std::string_view& text) { return take(text, "\"") || take(text, "''") || take(text, "\u2033") || take(text, "\u201d"); }

struct Unit {
  std::string_view name;
  double metres;
};
constexpr std::array<Unit, 16> units{{{"", 1}, {"m", 1}, {"m.", 1}, {"meter", 1}, {"meters", 1}, {"metre", 1}, {"metres", 1}, {"mtr", 1}, {"cm", 0.01}, {"km", 1000},
                                      {"ft", foot_m}, {"ft.", foot_m}, {"feet", foot_m}, {"foot", foot_m}, {"in", inch_m}, {"inch", inch_m}}};

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// What follows the feet: nothing, or inches.
std::optional<double> inches_m(std::string_view text) {
  text = trimmed(text);
  if (text.empty()) return 0.0;
  const std::optional<double> inches = take_number(text);
  if (!inches) return std::nullopt;
  text = trimmed(text);
  if (text.empty() || (take_inch_mark(text) && text.empty()) || text == "in") return *inches * inch_m;
  return std::nullopt;
}

constexpr std::array<std::string_view, 16> compass{"n",  "nne", "ne", "ene", "e",  "ese", "se", "sse",
                                                   "s",  "ssw", "sw", "wsw", "w",  "wnw", "nw", "nnw"};

/// "North-West" to "nw".
std::string compass_letters(std::string_view text) {
  std::string letters = lower_case(text);
  std::erase_if(letters, [](char c) { return c == '-' || c == ' ' || c == '_'; });
  for (const std::string_view word : {"north", "south", "east", "west"})
    for (std::size_t at = letters.find(word); at != std::string::npos; at = letters.find(word)) letters.erase(at + 1, word.size() - 1);
  return letters;
}

/// 0 to 360.
std::optional<double> parse_degrees(std::string_view text) {
  const std::optional<double> number = take_number(text);
  take(text, "\u00b0");
  return number && trimmed(text).empty() && *number <= 360 ? number : std::nullopt;
}

bool is_one_of(std::string_view value, std::initializer_list<std::string_view> values) {
  return std::ranges::find(values, value) != values.end();
}

}  // namespace

std::optional<double> parse_length_m(std::string_view text) {
  text = trimmed(text);
  const std::optional<double> number = take_number(text);
  if (!number) return std::nullopt;
  text = trimmed(text);
  if (take_foot_mark(text) && !text.starts_with("'")) {
    const std::optional<double> inches = inches_m(text);
    return inches ? std::optional(*number * foot_m + *inches) : std::nullopt;
  }
  const std::string unit = lower_case(text);
  for (const Unit& known : units)
    if (unit == known.name) return *number * known.metres;
  for (const std::string_view feet : {"ft", "feet", "foot"})
    if (unit.starts_with(feet))
      if (const auto inches = inches_m(std::string_view(unit).substr(feet.size()))) return *number * foot_m + *inches;
  return std::nullopt;
}

std::optional<double> parse_storeys(std::string_view text) {
  text = trimmed(text);
  const std::optional<double> number = take_number(text);
  return number && trimmed(text).empty() && *number <= most_storeys ? number : std::nullopt;
}

std::optional<double> parse_direction_deg(std::string_view text) {
  text = trimmed(text);
  const auto point = std::ranges::find(compass, compass_letters(text));
  if (point != compass.end()) return 22.5 * static_cast<double>(point - compass.begin());
  const bool is_negative = take(text, "-");
  const std::optional<double> number = parse_degrees(text);
  return !number || *number == 0 || !is_negative ? number : 360 - *number;
}

double compass_half_step_deg(std::string_view text) {
  const std::string letters = compass_letters(trimmed(text));
  if (std::ranges::find(compass, letters) == compass.end()) return 0;
  return letters.size() == 3 ? 11.25 : 22.5;
}

RoofShape parse_roof_shape(std::string_view text) {
  struct Name {
    std::string_view name;
    RoofShape shape;
  };
  static constexpr std::array<Name, 20> names{{{"flat", RoofShape::flat}, {"gabled", RoofShape::gabled}, {"pitched", RoofShape::gabled},
      {"hipped", RoofShape::hipped}, {"half-hipped", RoofShape::half_hipped}, {"half_hipped", RoofShape::half_hipped},
      {"pyramidal", RoofShape::pyramidal}, {"tented", RoofShape::pyramidal}, {"skillion", RoofShape::skillion}, {"lean_to", RoofShape::skillion}, {"gambrel", RoofShape::gambrel},
      {"mansard", RoofShape::mansard}, {"round", RoofShape::round}, {"arch", RoofShape::round}, {"barrel", RoofShape::round}, {"cone", RoofShape::cone},
      {"conical", RoofShape::cone}, {"dome", RoofShape::dome}, {"half-dome", RoofShape::dome}, {"onion", RoofShape::onion}}};
  const std::string name = lower_case(trimmed(text));
  for (const Name& known : names)
    if (name == known.name) return known.shape;
  return RoofShape::other;
}

void OsmBuildingTags::add(std::string_view key, std::string_view value) {
  if (!is_one_of(key, {"type", "source", "created_by", "note", "fixme"})) ++num_descriptive_;
  if (key == "type") {
    type_ = value == "multipolygon" ? Type::multipolygon : value == "building" ? Type::building : Type::none;
  } else if (key == "building" || key == "building:part") {
    const bool gone = is_one_of(value, {"no", "demolished", "razed", "destroyed", "dismantled", "removed", "proposed", "planned"});
    (key == "building" ? building_ : part_) = !gone && value != "bridge";
    no_walls_ |= is_one_of(value, {"roof", "carport", "canopy"});
  } else if (key == "location") {
    left_out_ |= is_one_of(value, {"underground", "subterranean"});
  } else if (key == "man_made" || key == "bridge") {
    left_out_ |= value == "bridge" || (key == "bridge" && value != "no");
  } else if (key == "demolished" || key == "razed") {
    left_out_ |= value != "no";
  } else if (key == "wall" || key == "building:wall") {
    no_walls_ |= value == "no";
  } else if (key == "height") {
    height_ = value;
  } else if (key == "building:height") {
    building_height_ = value;
  } else if (key == "est_height") {
    est_height_ = value;
  } else if (key == "min_height" || key == "building:min_height") {
    min_height_ = value;
  } else if (key == "building:levels") {
    levels_ = value;
  } else if (key == "building:levels:underground") {
    underground_levels_ = value;
  } else if (key == "building:min_level") {
    min_level_ = value;
  } else if (key == "roof:shape" || key == "building:roof:shape") {
    roof_shape_ = value;
  } else if (key == "roof:height") {
    roof_height_ = value;
  } else if (key == "roof:levels") {
    roof_levels_ = value;
  } else if (key == "roof:angle") {
    roof_angle_ = value;
  } else if (key == "roof:direction") {
    roof_direction_ = value;
  } else if (key == "roof:orientation") {
    roof_orientation_ = value;
  }
}

BuildingAttributes OsmBuildingTags::attributes(const std::string& feature, Diagnostics& diagnostics) const {
  const auto unusable = [&](const char* key, const std::string& value) {
    diagnostics.add(DiagnosticCode::unusable_height, feature, std::string(key) + "=" + value + " cannot be used");
  };
  const auto read = [&](const char* key, const std::string& value, auto parse, double least, double most) -> std::optional<double> {
    if (value.empty()) return std::nullopt;
    const std::optional<double> number = parse(value);
    if (number && *number >= least && *number <= most) return number;
    unusable(key, value);
    return std::nullopt;
  };
  constexpr double least_height_m = 0.01;

  BuildingAttributes attributes;
  attributes.height_m = read("height", height_, parse_length_m, least_height_m, highest_building_m);
  if (!attributes.height_m) attributes.height_m = read("building:height", building_height_, parse_length_m, least_height_m, highest_building_m);
  if (!attributes.height_m) attributes.height_m = read("est_height", est_height_, parse_length_m, least_height_m, highest_building_m);
  attributes.min_height_m = read("min_height", min_height_, parse_length_m, 0, highest_building_m);
  attributes.levels = read("building:levels", levels_, parse_storeys, 0, most_storeys);
  attributes.min_level = read("building:min_level", min_level_, parse_storeys, 0, most_storeys);
  attributes.roof_levels = read("roof:levels", roof_levels_, parse_storeys, 0, most_storeys);
  attributes.roof_height_m = read("roof:height", roof_height_, parse_length_m, 0, highest_building_m);
  attributes.roof_angle_deg = read("roof:angle", roof_angle_, [](std::string_view text) { return parse_degrees(trimmed(text)); }, 0, 89);
  attributes.roof_direction_deg = read("roof:direction", roof_direction_, parse_direction_deg, 0, 360);
  if (attributes.roof_direction_deg) attributes.roof_direction_half_step_deg = compass_half_step_deg(roof_direction_);
  attributes.roof_shape = roof_shape_.empty() ? RoofShape::flat : parse_roof_shape(roof_shape_);
  attributes.ridge_across = roof_orientation_ == "across";
  attributes.has_walls = !no_walls_;
  if (attributes.height_m && attributes.min_height_m && *attributes.min_height_m >= *attributes.height_m) {
    unusable("min_height", min_height_);
    attributes.min_height_m.reset();
  }
  if (attributes.levels && attributes.min_level && *attributes.min_level >= *attributes.levels + attributes.roof_levels.value_or(0)) {
    unusable("building:min_level", min_level_);
    attributes.min_level.reset();
  }
  return attributes;
}

}  // namespace priormap
