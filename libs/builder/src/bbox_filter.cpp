#include <priormap/builder/bbox_filter.hpp>

#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/image_bounds.hpp>

namespace priormap {
namespace {

Crs bbox_crs(const PriorOptions& options) {
  try {
    return Crs::parse(options.bbox_crs).horizontal();
  } catch (const CrsError& error) {
    throw CrsError(std::string("--bbox-crs: ") + error.what());
  }
}

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

}  // namespace priormap
