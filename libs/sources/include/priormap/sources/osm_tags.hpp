#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <priormap/core/diagnostics.hpp>
#include <priormap/sources/footprint.hpp>

namespace priormap {

/// A length as mappers write it: "22", "22 m", "22m", "7,5", "650 cm", "72 ft", "72'6\"", "72'". nullopt for anything else, negative lengths too.
std::optional<double> parse_length_m(std::string_view text);
/// A count of storeys, halves allowed: "3", "2.5", "2,5". nullopt for anything else.
std::optional<double> parse_storeys(std::string_view text);
/// "90", "90°", "-270", "NW", "north-west": degrees clockwise from north, 0 to 360.
std::optional<double> parse_direction_deg(std::string_view text);
/// Half a step of the compass that a direction in words comes from: 22.5 of those with eight points ("NW"), 11.25 of those with sixteen ("NNW"); 0 for numbers.
double compass_half_step_deg(std::string_view text);
/// `other` for a shape that priormap does not build.
RoofShape parse_roof_shape(std::string_view text);

/// What the tags of one OSM object say about a building (wiki: Key:building, Simple 3D buildings). Feed it every tag, then ask.
class OsmBuildingTags {
 public:
  void add(std::string_view key, std::string_view value);

  bool is_building() const { return building_ && !left_out_ && !is_underground(); }
  bool is_part() const { return part_ && !left_out_ && !is_underground(); }
  bool is_multipolygon() const { return type_ == Type::multipolygon; }
  bool is_building_relation() const { return type_ == Type::building; }
  /// Carries no tag that says what it is: an old multipolygon whose outer ways carry the tags.
  bool says_nothing() const { return num_descriptive_ == 0; }

  /// Values that cannot be read are reported under `feature` (702, 704) and treated as absent.
  BuildingAttributes attributes(const std::string& feature, Diagnostics& diagnostics) const;

 private:
  bool is_underground() const { return levels_ == "0" && !underground_levels_.empty() && height_.empty(); }

  enum class Type { none, multipolygon, building };
  bool building_ = false, part_ = false, left_out_ = false, no_walls_ = false;
  Type type_ = Type::none;
  int num_descriptive_ = 0;
  std::string height_, building_height_, est_height_, min_height_, levels_, underground_levels_, min_level_;
  std::string roof_shape_, roof_height_, roof_levels_, roof_angle_, roof_direction_, roof_orientation_;
};

}  // namespace priormap
