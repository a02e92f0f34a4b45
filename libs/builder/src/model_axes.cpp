#include "model_axes.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/transformer.hpp>

namespace priormap {
namespace {

/// Names without an authority that building models are known to carry.
const std::map<std::string, std::string> bare_names = {
    {"CH1903", "EPSG:21781"}, {"CH1903+", "EPSG:2056"}, {"RD", "EPSG:28992"}, {"ETRS89_UTM32", "EPSG:25832"}, {"ETRS89_UTM33", "EPSG:25833"},
};

/// How well a place fits a CRS: out of reach, somewhere, or where the CRS is meant to be used.
enum class Fit { none, reached, in_area };

Fit fit(const Crs& crs, const Eigen::Vector3d& place) {
  constexpr double border_deg = 1;
  const std::optional<GeoPoint> lon_lat = reach(crs, place);
  if (!lon_lat) return Fit::none;
  const std::optional<LonLatArea> area = crs.area_of_use();
  return !area || area->degrees_outside(*lon_lat) <= border_deg ? Fit::in_area : Fit::reached;
}

/// The forms that mean the authority's order of axes.
bool is_urn_or_url(std::string srs_name) {
  std::ranges::transform(srs_name, srs_name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::any_of(std::array{"urn:ogc:", "urn:x-ogc:", "urn:epsg:", "http"}, [&](const char* start) { return srs_name.starts_with(start); });
}

}  // namespace

std::optional<Crs> declared_crs(const std::string& srs_name, const std::string& file, bool overridden) {
  if (srs_name.empty()) return std::nullopt;
  const auto bare = bare_names.find(srs_name);
  try {
    return Crs::parse(bare == bare_names.end() ? srs_name : bare->second);
  } catch (const CrsError& error) {
    if (overridden) return std::nullopt;
    throw CrsError(file + ": srsName '" + srs_name + "': " + error.what() + "; name the CRS with --source-crs");
  }
}

Eigen::Vector3d first_point(const BuildingModel& model, const std::string& file) {
  for (const ModelPolygon& polygon : model.polygons) {
    if (!polygon.polygon.exterior.empty()) return polygon.polygon.exterior.front();
  }
  throw FormatError(file, model.id + " has no coordinates that are numbers");
}

Eigen::Vector3d swapped(const Eigen::Vector3d& p) { return {p.y(), p.x(), p.z()}; }

std::optional<GeoPoint> reach(const Crs& crs, const Eigen::Vector3d& place) {
  if (crs.is_geographic()) {
    if (std::abs(place.x()) > 180 || std::abs(place.y()) > 90) return std::nullopt;
    return GeoPoint{place.y(), place.x(), 0};
  }
  const Crs geographic = crs.geographic_base();
  const Transformer to_geographic(crs.horizontal(), geographic);
  const Eigen::Vector3d lon_lat = to_geographic.forward({place.x(), place.y(), 0});
  const Eigen::Vector3d back = to_geographic.inverse(lon_lat);
  if (!lon_lat.allFinite() || !back.allFinite() || (back - place).head<2>().norm() > 1) return std::nullopt;
  return GeoPoint{lon_lat.y(), lon_lat.x(), 0};
}

bool northing_comes_first(const std::string& srs_name, const Crs& crs, const Eigen::Vector3d& place) {
  if (!crs.authority_north_first()) return false;
  const Fit straight = fit(crs.horizontal(), place), turned = fit(crs.horizontal(), swapped(place));
  return straight == turned ? is_urn_or_url(srs_name) : turned > straight;
}

Eigen::Vector3d easting_first(const std::string& srs_name, const Crs& crs, const Eigen::Vector3d& place) {
  return northing_comes_first(srs_name, crs, place) ? swapped(place) : place;
}

}  // namespace priormap
