#pragma once
#include <array>
#include <optional>

#include <priormap/geodesy/geo_point.hpp>

namespace priormap {

class Crs;
struct Bounds2;

/// Geographic rectangle [degrees]; west > east where it crosses the antimeridian.
struct LonLatArea {
  double west_deg = 0, south_deg = 0, east_deg = 0, north_deg = 0;

  double width_deg() const;   ///< 0 to 360
  GeoPoint middle() const;
  std::array<GeoPoint, 4> corners() const;
  std::array<GeoPoint, 4> edge_middles() const;
  /// How far a place lies outside, along the meridian or the parallel; 0 inside.
  double degrees_outside(const GeoPoint& place) const;
};

/// Around both, the shorter way round the Earth.
LonLatArea united(const LonLatArea& a, const LonLatArea& b);

/// Where a rectangle of a CRS lies, in WGS 84; longitudes of a geographic CRS may be beyond 180. Nothing where it leaves the
/// domain of the CRS. @throws CrsError when no operation to WGS 84 is known
std::optional<LonLatArea> lon_lat_area(const Bounds2& bounds, const Crs& crs);

}  // namespace priormap
