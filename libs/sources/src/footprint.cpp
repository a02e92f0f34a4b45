#include <priormap/sources/footprint.hpp>

#include <array>

namespace priormap {
namespace {

template <class Attributes>
auto optional_numbers(Attributes& a) {
  return std::array{&a.height_m, &a.min_height_m, &a.levels, &a.min_level, &a.roof_levels, &a.roof_height_m, &a.roof_angle_deg, &a.roof_direction_deg};
}

}  // namespace

/// Numbers that are not known take a bit.
void pack(const BuildingAttributes& attributes, ByteWriter& out) {
  const auto numbers = optional_numbers(attributes);
  std::uint8_t known = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) known = static_cast<std::uint8_t>(known | (numbers[i]->has_value() << i));
  out.put(known);
  for (const auto* number : numbers)
    if (*number) out.put(**number);
  if (attributes.roof_direction_deg) out.put(attributes.roof_direction_half_step_deg);
  out.put(attributes.roof_shape);
  out.put(attributes.ridge_across);
  out.put(attributes.has_walls);
}

void unpack(ByteReader& in, BuildingAttributes& attributes) {
  const auto known = in.get<std::uint8_t>();
  const auto numbers = optional_numbers(attributes);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (known >> i & 1) *numbers[i] = in.get<double>();
  if (attributes.roof_direction_deg) attributes.roof_direction_half_step_deg = in.get<double>();
  attributes.roof_shape = in.get<RoofShape>();
  attributes.ridge_across = in.get<bool>();
  attributes.has_walls = in.get<bool>();
}

void pack(const Ring2& ring, ByteWriter& out) {
  out.put(static_cast<std::uint32_t>(ring.size()));
  out.put_all(std::span(ring));
}

void unpack(ByteReader& in, Ring2& ring) {
  ring.resize(in.get<std::uint32_t>());
  in.get_all(std::span(ring));
}

void pack(const Footprint& footprint, ByteWriter& out) {
  out.put(footprint.id);
  pack(footprint.attributes, out);
  out.put(footprint.kind);
  out.put(footprint.building);
  out.put(footprint.file);
  out.put(static_cast<std::uint32_t>(footprint.rings.size()));
  for (const Ring2& ring : footprint.rings) pack(ring, out);
}

void unpack(ByteReader& in, Footprint& footprint) {
  footprint.id = in.text();
  unpack(in, footprint.attributes);
  footprint.kind = in.get<Footprint::Kind>();
  footprint.building = in.get<std::uint32_t>();
  footprint.file = in.get<std::uint16_t>();
  footprint.rings.resize(in.get<std::uint32_t>());
  for (Ring2& ring : footprint.rings) unpack(in, ring);
}

}  // namespace priormap
