#include "box_filter.hpp"

#include <algorithm>
#include <cmath>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/option_crs.hpp>

namespace priormap {

BoxFilter::BoxFilter(const std::string& prior_crs, const std::vector<double>& bbox, const std::string& bbox_crs)
    : cover_{-INFINITY, -INFINITY, INFINITY, INFINITY} {
  if (bbox.empty()) return;
  if (bbox.size() != 4) throw UsageError("--bbox needs four numbers: west,south,east,north");
  box_ = {bbox[0], bbox[1], bbox[2], bbox[3]};
  if (!std::ranges::all_of(bbox, [](double v) { return std::isfinite(v); }) || box_.empty())
    throw UsageError("--bbox is empty: west must be less than east and south less than north (west,south,east,north)");
  everything_ = false;
  if (prior_crs.empty() || bbox_crs.empty()) {
    cover_ = box_;
    return;
  }
  to_box_.emplace(Crs::parse(prior_crs).horizontal(), horizontal_option_crs("--bbox-crs", bbox_crs));
  cover_ = outline_cover();
}

Bounds2 BoxFilter::outline_cover() const {
  constexpr int steps = 32;
  std::vector<Eigen::Vector3d> outline;
  for (int i = 0; i <= steps; ++i) {
    const double x = std::lerp(box_.min_x, box_.max_x, double(i) / steps), y = std::lerp(box_.min_y, box_.max_y, double(i) / steps);
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(x, box_.min_y, 0), Eigen::Vector3d(x, box_.max_y, 0),
                                     Eigen::Vector3d(box_.min_x, y, 0), Eigen::Vector3d(box_.max_x, y, 0)})
      outline.push_back(p);
  }
  to_box_->inverse(outline);
  Bounds2 cover{INFINITY, INFINITY, -INFINITY, -INFINITY};
  for (const Eigen::Vector3d& p : outline) {
    // Far away from where the prior's CRS is used: the box may hold anything.
    if (!p.allFinite()) return {-INFINITY, -INFINITY, INFINITY, INFINITY};
    cover = {std::min(cover.min_x, p.x()), std::min(cover.min_y, p.y()), std::max(cover.max_x, p.x()), std::max(cover.max_y, p.y())};
  }
  // Sides bend between the steps, by far less than this.
  const double margin = 0.02 * std::max(cover.max_x - cover.min_x, cover.max_y - cover.min_y);
  return {cover.min_x - margin, cover.min_y - margin, cover.max_x + margin, cover.max_y + margin};
}

void BoxFilter::keep_inside(PointCloud& points) const {
  if (everything_) return;
  std::vector<Eigen::Vector3d> positions(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) positions[i] = {points.position(i).x(), points.position(i).y(), 0};
  if (to_box_) to_box_->forward(positions);
  std::vector<std::uint32_t> inside;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (box_.contains(positions[i].x(), positions[i].y())) inside.push_back(std::uint32_t(i));
  if (inside.size() != points.size()) points = points.select(inside);
}

}  // namespace priormap
