#include "outline_frame.hpp"

#include <algorithm>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/lon_lat_area.hpp>

#include "lattice.hpp"

namespace priormap {

namespace {

constexpr const char* wgs84 = "EPSG:4326";

/// The operation by which the first source that comes from WGS 84 came, else the one that PROJ ranks first for where the points lie; empty where that is the one that
/// PROJ ranks first without knowing the place.
std::string particular_operation(const PriorManifest& prior, const Bounds2& extent) {
  const Crs lon_lat = Crs::parse(wgs84), crs = Crs::parse(prior.crs).horizontal();
  const std::string first_ranked = Transformer(lon_lat, crs).operation().proj_string;
  const auto source = std::ranges::find(prior.sources, wgs84, &PriorSource::crs);
  std::string operation = first_ranked;
  if (source != prior.sources.end() && !source->operation.proj_string.empty()) operation = source->operation.proj_string;
  else if (const std::optional<LonLatArea> area = extent.empty() ? std::nullopt : lon_lat_area(extent, crs)) operation = Transformer(lon_lat, crs, area).operation().proj_string;
  return operation == first_ranked ? "" : operation;
}

}  // namespace

OutlineFrame::OutlineFrame(const std::string& prior_crs, const std::string& file_crs, const std::string& operation) : file_crs_(file_crs), operation_(operation) {
  if (prior_crs.empty() || file_crs.empty()) return;
  const Crs prior = Crs::parse(prior_crs).horizontal(), file = Crs::parse(file_crs);
  if (operation.empty()) to_file_.emplace(prior, file);
  else from_file_.emplace(Transformer::by_operation(file, prior, operation));
}

OutlineFrame OutlineFrame::for_prior(const PriorManifest& prior, const Bounds2& extent) {
  if (prior.crs.empty()) return {"", "", ""};
  try {
    return {prior.crs, wgs84, particular_operation(prior, extent)};
  } catch (const CrsError&) {
    return {prior.crs, Crs::parse(prior.crs).geographic_base().name(), ""};
  }
}

void OutlineFrame::to_file(std::vector<Eigen::Vector3d>& points) const {
  if (to_file_) to_file_->forward(points);
  if (from_file_) from_file_->inverse(points);
}

void OutlineFrame::to_prior(std::vector<Eigen::Vector3d>& points) const {
  if (to_file_) to_file_->inverse(points);
  if (from_file_) from_file_->forward(points);
  for (Eigen::Vector3d& p : points)
    for (int axis = 0; axis < 2; ++axis) p[axis] = double(to_lattice(p[axis])) / 1000.0;
}

}  // namespace priormap
