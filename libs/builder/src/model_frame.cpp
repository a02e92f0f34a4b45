#include "model_frame.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

/// Names without an authority that building models are known to carry.
const std::map<std::string, std::string> bare_names = {
    {"CH1903", "EPSG:21781"}, {"CH1903+", "EPSG:2056"}, {"RD", "EPSG:28992"}, {"ETRS89_UTM32", "EPSG:25832"}, {"ETRS89_UTM33", "EPSG:25833"},
};

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

/// Longitude and latitude of a place; nothing where the CRS does not reach it, found by the way there and back.
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

/// Data may follow the authority's axis order: the URN and URL forms of srsName say so. Files that name a CRS that way and still write the
/// easting first are common, and so is the reverse: the order that fits the CRS better counts, and the form of the name where both fit alike.
bool northing_comes_first(const std::string& srs_name, const Crs& crs, const Eigen::Vector3d& place) {
  if (!crs.authority_north_first()) return false;
  const Fit straight = fit(crs.horizontal(), place), turned = fit(crs.horizontal(), swapped(place));
  return straight == turned ? is_urn_or_url(srs_name) : turned > straight;
}

/// The model's first point, easting first.
Eigen::Vector3d place_of(const BuildingModel& model, const Crs& crs, const std::string& file) {
  const Eigen::Vector3d place = first_point(model, file);
  return northing_comes_first(model.srs_name, crs, place) ? swapped(place) : place;
}

/// For the choice of an operation, whose areas of use are countries.
std::optional<LonLatArea> around(const std::optional<GeoPoint>& place) {
  constexpr double margin_deg = 0.01;
  if (!place) return std::nullopt;
  return LonLatArea{place->lon_deg - margin_deg, place->lat_deg - margin_deg, place->lon_deg + margin_deg, place->lat_deg + margin_deg};
}

}  // namespace

ModelFrames::ModelFrames(const PriorOptions& options, const BuildingModel& first, const std::string& file, const Events& events) : options_(options), events_(events) {
  InputCrs input = resolve_input_crs(options, declared_crs(first.srs_name, file, !options.source_crs.empty()), file, {});
  const std::optional<GeoPoint> middle = reach(input.crs.horizontal(), place_of(first, input.crs, file));
  if (!middle) throw CrsError(file + ": its coordinates lie out of reach of " + input.crs.human_name() + "; name their CRS with --source-crs");
  prior_ = resolve_prior_crs(options, {input}, LonLatArea{middle->lon_deg, middle->lat_deg, middle->lon_deg, middle->lat_deg}, events);
  first_ = std::move(input);
}

ModelFrames::Frame& ModelFrames::frame_of(const BuildingModel& model, const std::string& file) {
  if (const auto known = frames_.find(model.srs_name); known != frames_.end()) return known->second;
  const InputCrs input = resolve_input_crs(options_, declared_crs(model.srs_name, file, !options_.source_crs.empty()), file, events_);
  resolve_prior_crs(options_, {*first_, input}, std::nullopt, {});   // refuses heights that do not go together
  Frame frame{input.crs, std::nullopt, {input.crs.name(), input.assumed_vertical, {}}};
  Transformer transformer = transformer_to_prior(input.crs, *prior_, around(reach(input.crs.horizontal(), place_of(model, input.crs, file))), file);
  frame.source.operation = transformer.operation();
  if (!transformer.is_identity()) frame.to_prior = std::move(transformer);
  return frames_.emplace(model.srs_name, std::move(frame)).first->second;
}

bool ModelFrames::swaps_axes(const BuildingModel& model, const std::string& file) {
  const auto [place, is_new] = swaps_axes_.try_emplace({file, model.srs_name});
  if (is_new) place->second = northing_comes_first(model.srs_name, frame_of(model, file).crs, first_point(model, file));
  return place->second;
}

void ModelFrames::to_prior(BuildingModel& model, const std::string& file) {
  const Frame& frame = frame_of(model, file);
  const bool swap_axes = swaps_axes(model, file);
  for (ModelPolygon& polygon : model.polygons) {
    bool good = true;
    for_each_ring(polygon.polygon, [&](Ring3& ring) {
      if (swap_axes) {
        for (Eigen::Vector3d& p : ring) p = swapped(p);
      }
      if (frame.to_prior) frame.to_prior->forward(ring);
      for (const Eigen::Vector3d& p : ring) good = good && p.allFinite();
    });
    if (!good) polygon.polygon = {};
  }
}

}  // namespace priormap
