#include <priormap/builder/bbox_filter.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

constexpr int edge_steps = 64;

/// Points along west, east, south and north edge, in the other CRS.
std::array<std::vector<Eigen::Vector3d>, 4> transformed_edges(const Bounds2& b, const Transformer& transformer) {
  std::array<std::vector<Eigen::Vector3d>, 4> edges;
  for (int i = 0; i <= edge_steps; ++i) {
    const double t = static_cast<double>(i) / edge_steps;
    const double x = b.min_x + t * (b.max_x - b.min_x), y = b.min_y + t * (b.max_y - b.min_y);
    edges[0].emplace_back(b.min_x, y, 0);
    edges[1].emplace_back(b.max_x, y, 0);
    edges[2].emplace_back(x, b.min_y, 0);
    edges[3].emplace_back(x, b.max_y, 0);
  }
  for (auto& edge : edges) transformer.forward(edge);
  return edges;
}

struct Range {
  double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();
};

Range range_of(const std::vector<Eigen::Vector3d>& points, int axis) {
  Range range;
  for (const Eigen::Vector3d& p : points) {
    if (!p.allFinite()) return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    range.min = std::min(range.min, p[axis]);
    range.max = std::max(range.max, p[axis]);
  }
  return range;
}

/// Between two samples of an edge the curve strays from the chord by far less than one step.
double margin_of(const Range& across, const Range& along) { return (across.max - across.min) + (along.max - along.min) / (edge_steps * edge_steps); }

struct EdgeRanges {
  Range west, east, south, north;   ///< x of west and east, y of south and north
  double margin_x, margin_y;
  bool known() const { return std::isfinite(west.min + east.max + south.min + north.max + margin_x + margin_y); }
};

EdgeRanges edge_ranges(const Bounds2& bounds, const Transformer& transformer) {
  const auto edges = transformed_edges(bounds, transformer);
  EdgeRanges r{range_of(edges[0], 0), range_of(edges[1], 0), range_of(edges[2], 1), range_of(edges[3], 1), 0, 0};
  const Range along_x = range_of(edges[2], 0), along_y = range_of(edges[0], 1);
  r.margin_x = std::max(margin_of(r.west, along_y), margin_of(r.east, along_y)) / edge_steps + 1e-9 * std::abs(along_x.max);
  r.margin_y = std::max(margin_of(r.south, along_x), margin_of(r.north, along_x)) / edge_steps + 1e-9 * std::abs(along_y.max);
  return r;
}

Crs bbox_crs(const PriorOptions& options) {
  try {
    return Crs::parse(options.bbox_crs).horizontal();
  } catch (const CrsError& error) {
    throw CrsError(std::string("--bbox-crs: ") + error.what());
  }
}

}  // namespace

std::optional<Bounds2> enclosing_bounds(const Bounds2& bounds, const Transformer& target_from_source) {
  const EdgeRanges r = edge_ranges(bounds, target_from_source);
  if (!r.known()) return std::nullopt;
  return Bounds2{std::min(r.west.min, r.east.min) - r.margin_x, std::min(r.south.min, r.north.min) - r.margin_y,
                 std::max(r.west.max, r.east.max) + r.margin_x, std::max(r.south.max, r.north.max) + r.margin_y};
}

BboxFilter::BboxFilter(const PriorOptions& options, const Crs& prior) {
  if (options.bbox.empty()) return;
  bbox_ = Bounds2{options.bbox[0], options.bbox[1], options.bbox[2], options.bbox[3]};
  prior_from_bbox_.emplace(bbox_crs(options), prior.horizontal());
  if (prior_from_bbox_->is_identity()) {
    prior_from_bbox_.reset();
    outer_ = inner_ = *bbox_;
    return;
  }
  const EdgeRanges r = edge_ranges(*bbox_, *prior_from_bbox_);
  if (!r.known()) return;
  outer_ = enclosing_bounds(*bbox_, *prior_from_bbox_);
  inner_ = {r.west.max + r.margin_x, r.south.max + r.margin_y, r.east.min - r.margin_x, r.north.min - r.margin_y};
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
