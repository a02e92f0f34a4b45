#include "outline_frame.hpp"

#include <priormap/core/error.hpp>

#include "lattice.hpp"

namespace priormap {

OutlineFrame::OutlineFrame(const std::string& prior_crs, const std::string& file_crs) : file_crs_(file_crs) {
  if (!prior_crs.empty() && !file_crs.empty())
    to_file_.emplace(Crs::parse(prior_crs).horizontal(), Crs::parse(file_crs));
}

OutlineFrame OutlineFrame::for_prior(const std::string& prior_crs) {
  if (prior_crs.empty()) return {"", ""};
  try {
    return {prior_crs, "EPSG:4326"};
  } catch (const CrsError&) {
    return {prior_crs, Crs::parse(prior_crs).geographic_base().name()};
  }
}

void OutlineFrame::to_file(std::vector<Eigen::Vector3d>& points) const {
  if (to_file_) to_file_->forward(points);
}

void OutlineFrame::to_prior(std::vector<Eigen::Vector3d>& points) const {
  if (to_file_) to_file_->inverse(points);
  for (Eigen::Vector3d& p : points)
    for (int axis = 0; axis < 2; ++axis) p[axis] = double(to_lattice(p[axis])) / 1000.0;
}

}  // namespace priormap
