#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <priormap/core/packed_list.hpp>
#include <priormap/tessellation/polygon.hpp>
#include <priormap/tessellation/roof.hpp>

namespace priormap {

/// What a source says about the shape of a building or of a part of one; absent where it says nothing.
struct BuildingAttributes {
  std::optional<double> height_m;        ///< of the top, roof included, above the ground
  std::optional<double> min_height_m;    ///< of the lowest wall edge above the ground
  std::optional<double> levels;          ///< storeys above the ground, without those in the roof
  std::optional<double> min_level;       ///< storeys left open below
  std::optional<double> roof_levels;
  std::optional<double> roof_height_m;
  std::optional<double> roof_angle_deg;      ///< slope
  std::optional<double> roof_direction_deg;  ///< down the slope, clockwise from true north; in the prior's CRS from its grid's
  double roof_direction_half_step_deg = 0;   ///< of the compass whose point names the direction: a wall that near is meant; 0: a number, as it stands
  RoofShape roof_shape = RoofShape::flat;
  bool ridge_across = false;  ///< the ridge runs along the shorter side
  bool has_walls = true;      ///< false: a roof on posts
};

/// The outline of a building or of a part of one, as a source gives it.
struct Footprint {
  enum class Kind : std::uint8_t { outline, part };
  static constexpr std::uint32_t no_building = 0xffffffffu;

  std::string id;             ///< in the source: "way/123", "relation/7"
  std::vector<Ring2> rings;   ///< even-odd: holes and several polygons in any order; in the source's CRS, east before north
  BuildingAttributes attributes;
  Kind kind = Kind::outline;
  std::uint32_t building = no_building;  ///< outline and parts that the source ties together carry the same number
  std::uint16_t file = 0;                ///< index of the input file
};

void pack(const BuildingAttributes& attributes, ByteWriter& out);
void unpack(ByteReader& in, BuildingAttributes& attributes);
void pack(const Ring2& ring, ByteWriter& out);
void unpack(ByteReader& in, Ring2& ring);
void pack(const Footprint& footprint, ByteWriter& out);
void unpack(ByteReader& in, Footprint& footprint);

/// As many as a country has.
using FootprintList = PackedList<Footprint>;

}  // namespace priormap
