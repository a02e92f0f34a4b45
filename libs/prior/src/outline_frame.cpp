#include "outline_frame.hpp"

#include <algorithm>

#include <priormap/core/error.hpp>

#include "lattice.hpp"

namespace priormap {

namespace {

constexpr const char* wgs84 = "EPSG:4326";

/// The operation by which the first source that comes from WGS 84 came; empty where it is the one that PROJ ranks first anyway, or there is no such source.
std::string particular_operation(const PriorManifest& prior) {
  const auto source = std::ranges::find(prior.sources, wgs84, &PriorSource::crs);
  if (source == prior.sources.end() || source->operation.proj_string.empty()) return "";
  const std::string& operation = source->operation.proj_string;
  return operation == Transformer(Crs::parse(wgs84), Crs::parse(prior.crs).horizontal()).operation().proj_string ? "" : operation;
}

}  // namespace

OutlineFrame::OutlineFrame(const std::string& prior_crs, const std::string& file_crs, const std::string& operation) : file_crs_(file_crs), operation_(operation) {
  if (prior_crs.empty() || file_crs.empty()) return;
  const Crs prior = Crs::parse(prior_crs).horizontal(), file = Crs::parse(file_crs);
  if (operation.empty()) to_file_.emplace(prior, file);
  else from_file_.emplace(Transformer::by_operation(file, prior, operation));
}

OutlineFrame OutlineFrame::for_prior(const PriorManifest& prior) {
  if (prior.crs.empty()) return {"", "", ""};
  try {
    return {prior.crs, wgs84, particular_operation(prior)};
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
