#pragma once
#include <optional>
#include <span>

#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/sources/height_raster.hpp>
#include <priormap/tessellation/polygon.hpp>

namespace priormap {

/// Heights of the ground in the prior's CRS: from a terrain raster, and where that knows none, a constant.
/// One object per thread; copies open the raster once more.
class GroundModel {
 public:
  /// @param constant_m  none: unknown outside the terrain
  /// @param constant_to_prior  from the CRS that `constant_m` is given in, with the prior's horizontal part, to the prior's; none: the same
  GroundModel(std::optional<HeightRaster> terrain, std::optional<double> constant_m, std::optional<Transformer> constant_to_prior);

  std::optional<double> at(const Eigen::Vector2d& place) const;

  const std::optional<HeightRaster>& terrain() const { return terrain_; }

  struct Under {
    double lowest_z = 0;   ///< along the outline: where walls start
    double median_z = 0;   ///< along the outline: where heights count from, so that the noise of a terrain does not sink the roofs
  };
  /// From places every `step_m` along all rings; nothing where the ground is known nowhere.
  std::optional<Under> under(std::span<const Polygon2> polygons) const;

 private:
  std::optional<HeightRaster> terrain_;
  std::optional<double> constant_m_;
  std::optional<Transformer> constant_to_prior_;
  double step_m_ = 1;
};

}  // namespace priormap
