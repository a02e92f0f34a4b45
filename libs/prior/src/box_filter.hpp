#pragma once
#include <optional>
#include <string>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// Keeps the points of a prior that lie in a half-open box of another CRS.
class BoxFilter {
 public:
  /// @param bbox  west, south, east, north; empty: everything
  /// @param bbox_crs  empty: that of the prior
  /// @throws UsageError for a box that is none, CrsError when no operation leads to its CRS
  BoxFilter(const std::string& prior_crs, const std::vector<double>& bbox, const std::string& bbox_crs);

  /// Holds the box, in the prior's CRS; a little more than it.
  const Bounds2& cover() const { return cover_; }
  void keep_inside(PointCloud& points) const;

 private:
  Bounds2 outline_cover() const;
  Bounds2 box_, cover_;
  bool everything_ = true;
  std::optional<Transformer> to_box_;
};

}  // namespace priormap
