#pragma once
#include <compare>
#include <cstdint>
#include <tuple>

namespace priormap {

/// One point of a tile on the millimetre lattice, 32 bytes: what is spilled, sorted and written.
struct PointRecord {
  std::int32_t x = 0, y = 0;   ///< [0.001 CRS units] from the tile's lower-left corner
  std::int32_t z = 0;          ///< [mm] in the prior's vertical CRS
  std::int16_t normal[3] = {0, 0, 0};   ///< 1/32767; zero: unknown
  std::uint8_t classification = 0;
  std::uint8_t halo = 0;       ///< 1: belongs to a neighbouring tile, here as a witness only
  std::uint16_t source = 0;
  std::uint16_t sigma_mm = unknown_sigma;
  std::uint32_t feature = 0;
  float intensity = 0;   ///< never NaN

  static constexpr std::uint16_t unknown_sigma = 65535;
};
static_assert(sizeof(PointRecord) == 32);

/// The order of points in a tile. Total: equal means equal in every column.
inline auto sort_key(const PointRecord& p) {
  return std::make_tuple(p.x, p.y, p.z, p.source, p.feature, p.classification, p.normal[0], p.normal[1], p.normal[2], p.sigma_mm,
                         p.intensity, p.halo);
}
inline bool operator<(const PointRecord& a, const PointRecord& b) { return sort_key(a) < sort_key(b); }

/// Two samples of one feature of one source at one place are one point.
inline bool same_point(const PointRecord& a, const PointRecord& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.source == b.source && a.feature == b.feature;
}

}  // namespace priormap
