#include <priormap/geodesy/lon_lat_area.hpp>

#include <algorithm>
#include <cmath>

#include <priormap/geodesy/image_bounds.hpp>

namespace priormap {
namespace {

constexpr double whole_circle_deg = 360;

double wrapped(double lon_deg) { return std::remainder(lon_deg, whole_circle_deg); }

double degrees_eastward(double from_deg, double to_deg) {
  const double way = std::fmod(to_deg - from_deg, whole_circle_deg);
  return way < 0 ? way + whole_circle_deg : way;
}

/// From `west` to the east end that lies farther on.
LonLatArea eastward(const LonLatArea& west, const LonLatArea& other) {
  const double to_other_end = degrees_eastward(west.west_deg, other.west_deg) + other.width_deg();
  const double width = std::max(west.width_deg(), to_other_end);
  LonLatArea area{west.west_deg, std::min(west.south_deg, other.south_deg), wrapped(west.west_deg + width), std::max(west.north_deg, other.north_deg)};
  if (width >= whole_circle_deg) area.west_deg = -180, area.east_deg = 180;
  return area;
}

}  // namespace

double LonLatArea::width_deg() const { return west_deg <= east_deg ? east_deg - west_deg : east_deg + whole_circle_deg - west_deg; }

GeoPoint LonLatArea::middle() const { return {0.5 * (south_deg + north_deg), west_deg <= east_deg ? 0.5 * (west_deg + east_deg) : wrapped(west_deg + 0.5 * width_deg()), 0}; }

std::array<GeoPoint, 4> LonLatArea::corners() const {
  return {{{south_deg, west_deg, 0}, {south_deg, east_deg, 0}, {north_deg, west_deg, 0}, {north_deg, east_deg, 0}}};
}

std::array<GeoPoint, 4> LonLatArea::edge_middles() const {
  const GeoPoint center = middle();
  return {{{center.lat_deg, west_deg, 0}, {center.lat_deg, east_deg, 0}, {south_deg, center.lon_deg, 0}, {north_deg, center.lon_deg, 0}}};
}

double LonLatArea::degrees_outside(const GeoPoint& place) const {
  const double width = width_deg();
  const double east_of_west = std::remainder(place.lon_deg - west_deg - width / 2, whole_circle_deg) + width / 2;   // from the middle of the area, either way
  return std::max({0.0, -east_of_west, east_of_west - width, south_deg - place.lat_deg, place.lat_deg - north_deg});
}

LonLatArea united(const LonLatArea& a, const LonLatArea& b) {
  const LonLatArea from_a = eastward(a, b), from_b = eastward(b, a);
  return from_b.width_deg() < from_a.width_deg() ? from_b : from_a;
}

std::optional<LonLatArea> lon_lat_area(const Bounds2& bounds, const Crs& crs) {
  Transformer to_lon_lat(crs.horizontal(), Crs::parse("EPSG:4326"));
  const double middle_deg = to_lon_lat.forward({0.5 * (bounds.min_x + bounds.max_x), 0.5 * (bounds.min_y + bounds.max_y), 0}).x();
  if (!std::isfinite(middle_deg)) return std::nullopt;
  to_lon_lat.keep_target_longitudes_around(middle_deg);
  const auto image = image_bounds(bounds, to_lon_lat);
  if (!image) return std::nullopt;
  const Bounds2& b = image->outer;
  if (b.max_x - b.min_x >= whole_circle_deg) return LonLatArea{-180, b.min_y, 180, b.max_y};
  if (b.min_x >= -180 && b.max_x <= 180) return LonLatArea{b.min_x, b.min_y, b.max_x, b.max_y};
  return LonLatArea{wrapped(b.min_x), b.min_y, wrapped(b.max_x), b.max_y};
}

}  // namespace priormap
