#include "model_frame.hpp"

#include <priormap/core/error.hpp>

#include "model_axes.hpp"

namespace priormap {
namespace {

/// For the choice of an operation, whose areas of use are countries.
std::optional<LonLatArea> around(const std::optional<GeoPoint>& place) {
  constexpr double margin_deg = 0.01;
  if (!place) return std::nullopt;
  return LonLatArea{place->lon_deg - margin_deg, place->lat_deg - margin_deg, place->lon_deg + margin_deg, place->lat_deg + margin_deg};
}

}  // namespace

ModelFrames::ModelFrames(const PriorOptions& options, const std::string& srs_name, const Eigen::Vector3d& place, const std::string& file, DecidingPlaces deciding, const Events& events)
    : options_(options), events_(events), deciding_(std::move(deciding)) {
  InputCrs input = resolve_input_crs(options, declared_crs(srs_name, file, !options.source_crs.empty()), file, {});
  const std::optional<GeoPoint> middle = reach(input.crs.horizontal(), easting_first(srs_name, input.crs, place));
  if (!middle) throw CrsError(file + ": its coordinates lie out of reach of " + input.crs.human_name() + "; name their CRS with --source-crs");
  prior_ = resolve_prior_crs(options, {input}, LonLatArea{middle->lon_deg, middle->lat_deg, middle->lon_deg, middle->lat_deg}, events);
  first_ = std::move(input);
}

ModelFrames::Frame& ModelFrames::frame_of(const BuildingModel& model, const std::string& file) {
  if (const auto known = frames_.find(model.srs_name); known != frames_.end()) return known->second;
  const InputCrs input = resolve_input_crs(options_, declared_crs(model.srs_name, file, !options_.source_crs.empty()), file, events_);
  resolve_prior_crs(options_, {*first_, input}, std::nullopt, {});   // refuses heights that do not go together
  Frame frame{input.crs, std::nullopt, {input.crs.name(), input.assumed_vertical, {}}};
  Transformer transformer = transformer_to_prior(input.crs, *prior_, around(reach(input.crs.horizontal(), easting_first(model.srs_name, input.crs, deciding_place(model, file)))), file);
  frame.source.operation = transformer.operation();
  if (!transformer.is_identity()) frame.to_prior = std::move(transformer);
  return frames_.emplace(model.srs_name, std::move(frame)).first->second;
}

bool ModelFrames::swaps_axes(const BuildingModel& model, const std::string& file) {
  const auto [place, is_new] = swaps_axes_.try_emplace({model.srs_name, file});
  if (is_new) place->second = northing_comes_first(model.srs_name, frame_of(model, file).crs, deciding_place(model, file));
  return place->second;
}

Eigen::Vector3d ModelFrames::deciding_place(const BuildingModel& model, const std::string& file) const {
  const auto place = deciding_.find({model.srs_name, file});
  return place != deciding_.end() ? place->second : first_point(model, file);
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
