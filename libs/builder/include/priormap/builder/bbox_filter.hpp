#pragma once
#include <optional>
#include <string>

#include <priormap/builder/prior_options.hpp>
#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/geo_point.hpp>
#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// --bbox: half-open in its own CRS, so that neighbouring boxes share no point and lose none.
/// One object per thread; copies are cheap.
class BboxFilter {
 public:
  /// @throws CrsError when --bbox-crs is unknown or no operation leads to it from the prior's CRS.
  BboxFilter(const PriorOptions& options, const Crs& prior);

  /// True without --bbox as well.
  bool contains(double x, double y) const;
  /// The points of a cloud in the prior's CRS that lie inside.
  PointCloud keep(const PointCloud& points) const;
  /// In the prior's CRS: nothing outside of it is kept. Nothing known: no --bbox, or a box beyond the CRS's domain.
  const std::optional<Bounds2>& outer() const { return outer_; }
  bool is_active() const { return bbox_.has_value(); }

 private:
  std::optional<Bounds2> bbox_;
  std::optional<Transformer> prior_from_bbox_;   ///< none: bbox and prior have the same CRS
  std::optional<Bounds2> outer_;
  Bounds2 inner_;                                ///< everything inside of it is kept; empty: not known
};

/// Why --bbox kept nothing of data with the extent `data` in `data_crs`: where they lie in the box's CRS, and whether the box would meet them with its axes
/// in the other order.
std::string missed_by_bbox(const PriorOptions& options, const Bounds2& data, const Crs& data_crs);

}  // namespace priormap
