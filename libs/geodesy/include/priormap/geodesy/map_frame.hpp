#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <string>

#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/geo_point.hpp>

namespace priormap {

/// The metric frame `map` of one run: x east, y north, z up, true metres near the first pose.
///
/// Transverse Mercator at the first pose with k0 = 1 + h/R (h: ellipsoidal height of the first pose, R: Gaussian radius
/// there), on the geographic base CRS of the prior's CRS; z is the height in the prior's vertical CRS, not reduced. x = y = 0 at
/// the first pose. Distances agree with geodesic distances scaled to the first pose's height within 1 ppm over 5 km.
/// Or a local metric frame (a cloud without CRS): then `map` is that frame itself and there is no georeference.
///
/// One object per thread; copies make their own PROJ context.
class MapFrame {
 public:
  /// @param projected  the prior's CRS (projected, with or without heights)
  /// @param origin     a position in that CRS [CRS units, heights in m]
  /// @throws CrsError when `projected` is geographic.
  static MapFrame at(const Crs& projected, const Eigen::Vector3d& origin);
  static MapFrame local();

  bool georeferenced() const;
  const Crs& projected() const;             ///< must be georeferenced
  GeoPoint origin() const;                  ///< of x = y = 0, in the geographic base CRS, ellipsoidal height
  double scale_factor() const;              ///< k0
  std::string definition() const;           ///< PROJ string of the frame

  void to_map(std::span<Eigen::Vector3d> projected_points) const;      ///< in place
  void to_projected(std::span<Eigen::Vector3d> map_points) const;      ///< in place
  void to_lon_lat(std::span<Eigen::Vector3d> map_points) const;        ///< lon_deg, lat_deg (WGS 84 / base CRS), z unchanged
  Eigen::Vector3d to_map(const Eigen::Vector3d& projected_point) const;
  Eigen::Vector3d to_projected(const Eigen::Vector3d& map_point) const;

  /// Angle from map north to the projected CRS's grid north at a map point, positive where grid north lies clockwise
  /// of map north [rad]: R_map = Rz(-angle) R_projected.
  double grid_rotation(const Eigen::Vector3d& p_map) const;
  /// Metres of the projected CRS per metre of map at a map point.
  double grid_scale(const Eigen::Vector3d& p_map) const;
  /// Poses: positions through PROJ, orientations by the grid rotation at the position.
  Eigen::Isometry3d pose_to_map(const Eigen::Isometry3d& T_projected_sensor) const;
  Eigen::Isometry3d pose_to_projected(const Eigen::Isometry3d& T_map_sensor) const;
  /// Angle from true north to map north at a map point (meridian convergence of `map`) [rad, positive: map north east of true north].
  double convergence(const Eigen::Vector3d& p_map) const;

 private:
  struct Impl;
  explicit MapFrame(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

}  // namespace priormap
