#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>

#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/geo_point.hpp>
#include <priormap/geodesy/transformer.hpp>

namespace priormap {

/// The metric frame `map` of one run: x east, y north, z up, true metres near the first pose.
///
/// Transverse Mercator at the first pose with k0 = 1 + h/R (h: ellipsoidal height of the first pose, R: Gaussian radius
/// there), on the geographic base CRS of the prior's CRS; z is the height in the prior's vertical CRS in metres, not reduced.
/// x = y = 0 at the first pose. Distances agree with geodesic distances scaled to the first pose's height within 1 ppm over 5 km.
/// Or a local metric frame (a cloud without CRS): then `map` is that frame itself and there is no georeference.
///
/// One object per thread; copies make their own PROJ context.
class MapFrame {
 public:
  /// Where the prior's heights count from a geoid or are undeclared, h = height + EGM96 undulation: good enough for the scale.
  /// @param projected  the prior's CRS (projected, with or without heights)
  /// @param origin     a position in that CRS [CRS units; undeclared heights in m]
  /// @throws CrsError when `projected` is not projected, `origin` lies outside of it, or the EGM96 grid is not installed.
  static MapFrame at(const Crs& projected, const Eigen::Vector3d& origin);
  static MapFrame local();

  bool georeferenced() const;
  // All below but the points of a local frame, which pass unchanged, @throw CrsError where there is no georeference.
  const Crs& projected() const;
  const Crs& crs() const;                   ///< of x and y: the transverse Mercator
  GeoPoint origin() const;                  ///< of x = y = 0, in the geographic base CRS, ellipsoidal height
  double scale_factor() const;              ///< k0
  std::string definition() const;           ///< PROJ string of the frame

  void to_map(std::span<Eigen::Vector3d> projected_points) const;      ///< in place
  void to_projected(std::span<Eigen::Vector3d> map_points) const;      ///< in place
  /// lon_deg, lat_deg in WGS 84, z unchanged; in place. @throws CrsError also when no transformation to WGS 84 is known.
  void to_lon_lat(std::span<Eigen::Vector3d> map_points) const;
  Eigen::Vector3d to_map(const Eigen::Vector3d& projected_point) const;
  Eigen::Vector3d to_projected(const Eigen::Vector3d& map_point) const;
  Eigen::Vector3d to_lon_lat(const Eigen::Vector3d& map_point) const;

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
  struct Georeference {
    Transformer projected_to_map;   ///< x and y
    Transformer map_to_base;        ///< x and y to longitude and latitude of the geographic base CRS
    Crs projected;
    double height_unit_m = 1;       ///< signed: negative for depths
    GeoPoint origin;
    double scale_factor = 1;
  };
  MapFrame() = default;
  const Georeference& georeference() const;
  Eigen::Matrix2d projected_per_map(const Eigen::Vector3d& p_map) const;

  std::optional<Georeference> georeference_;
  std::optional<Transformer> map_to_wgs84_;
};

}  // namespace priormap
