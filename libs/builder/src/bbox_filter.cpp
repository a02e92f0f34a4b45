#include <priormap/builder/bbox_filter.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

#include <priormap/geodesy/image_bounds.hpp>
#include <priormap/geodesy/option_crs.hpp>

namespace priormap {
namespace {

Crs bbox_crs(const PriorOptions& options) { return horizontal_option_crs("--bbox-crs", options.bbox_crs); }

bool overlap(const Bounds2& a, const Bounds2& b) { return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y; }

/// What may be wrong with a box that misses the data. @param there  the data in the box's CRS
std::string advice(const PriorOptions& options, const Bounds2& data, const Crs& data_crs, const std::optional<Bounds2>& there) {
  const Bounds2 box = options.box();
  const bool are_degrees = bbox_crs(options).is_geographic();
  if (there && overlap(*there, {box.min_y, box.min_x, box.max_y, box.max_x})) return ": were the box's numbers given as S,W,N,E?";
  if (!data.empty() && overlap(data, box) && !bbox_crs(options).equivalent_to(data_crs.horizontal())) return ": is the box in their CRS? --bbox-crs " + data_crs.horizontal().name() + " says so";
  if (are_degrees && (std::max(std::abs(box.min_x), std::abs(box.max_x)) > 360 || std::max(std::abs(box.min_y), std::abs(box.max_y)) > 90))
    return ": the box's numbers are no degrees; --bbox-crs says which CRS they are in";
  return "; --bbox-crs says where the box is in another CRS";
}

}  // namespace

BboxFilter::BboxFilter(const PriorOptions& options, const Crs& prior) {
  if (options.bbox.empty()) return;
  bbox_ = options.box();
  prior_from_bbox_.emplace(bbox_crs(options), prior.horizontal());
  prior_from_bbox_->keep_source_longitudes_around(0.5 * (bbox_->min_x + bbox_->max_x));
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
  std::ostringstream text;
  text << std::setprecision(8) << "lies inside --bbox (W,S,E,N in " << options.bbox_crs << ")";
  const auto image = data.empty() ? std::nullopt : image_bounds(data, Transformer(data_crs.horizontal(), bbox_crs(options)));
  if (image) text << "; the data reach over " << image->outer.min_x << "," << image->outer.min_y << "," << image->outer.max_x << "," << image->outer.max_y;
  text << advice(options, data, data_crs, image ? std::optional(image->outer) : std::nullopt);
  return text.str();
}

}  // namespace priormap
