#include <priormap/builder/bbox_filter.hpp>

#include <iomanip>
#include <sstream>
#include <vector>

#include <priormap/geodesy/image_bounds.hpp>
#include <priormap/geodesy/option_crs.hpp>

namespace priormap {
namespace {

Crs bbox_crs(const PriorOptions& options) { return horizontal_option_crs("--bbox-crs", options.bbox_crs); }

bool overlap(const Bounds2& a, const Bounds2& b) { return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y; }

}  // namespace

BboxFilter::BboxFilter(const PriorOptions& options, const Crs& prior) {
  if (options.bbox.empty()) return;
  bbox_ = Bounds2{options.bbox[0], options.bbox[1], options.bbox[2], options.bbox[3]};
  prior_from_bbox_.emplace(bbox_crs(options), prior.horizontal());
  if (prior_from_bbox_->is_identity()) {
    prior_from_bbox_.reset();
    outer_ = inner_ = *bbox_;
    return;
  }
  if (const auto image = image_bounds(*bbox_, *prior_from_bbox_)) {
    outer_ = image->outer;
    inner_ = image->inner;
  }
}

bool BboxFilter::contains(double x, double y) const {
  if (!bbox_ || inner_.contains(x, y)) return true;
  if (!prior_from_bbox_ || (outer_ && !outer_->contains(x, y))) return false;
  const Eigen::Vector3d p = prior_from_bbox_->inverse(Eigen::Vector3d(x, y, 0));
  return bbox_->contains(p.x(), p.y());
}

PointCloud BboxFilter::keep(const PointCloud& points) const {
  std::vector<std::uint32_t> inside;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points.position(i);
    if (contains(p.x(), p.y())) inside.push_back(static_cast<std::uint32_t>(i));
  }
  return inside.size() == points.size() ? points : points.select(inside);
}

std::string missed_by_bbox(const PriorOptions& options, const Bounds2& data, const Crs& data_crs) {
  const std::vector<double>& box = options.bbox;
  std::ostringstream text;
  text << std::setprecision(8) << "lies inside --bbox (W,S,E,N in " << options.bbox_crs << ")";
  const auto image = data.empty() ? std::nullopt : image_bounds(data, Transformer(data_crs.horizontal(), bbox_crs(options)));
  if (!image) return text.str();
  const Bounds2& there = image->outer;
  text << "; the data reach over " << there.min_x << "," << there.min_y << "," << there.max_x << "," << there.max_y;
  if (overlap(there, {box[1], box[0], box[3], box[2]})) text << ": were the box's numbers given as S,W,N,E?";
  return text.str();
}

}  // namespace priormap
