#include <priormap/geodesy/map_frame.hpp>

#include <array>
#include <cmath>
#include <utility>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/undulation.hpp>

#include "ellipsoid.hpp"

namespace priormap {
namespace {

// Central differences over this length are exact to 1e-11 of the result for projections of the Earth.
constexpr double derivative_step_m = 10;

Eigen::Vector3d base_position(const Crs& projected, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d position = Transformer(projected.horizontal(), projected.geographic_base()).forward(origin);
  if (!position.allFinite()) throw CrsError("the origin of the map frame lies outside of " + projected.human_name());
  return position;
}

double signed_height_unit_m(const Crs& crs) { return (crs.heights_point_down() ? -1 : 1) * crs.vertical_unit_m(); }

double ellipsoidal_height_m(const Crs& projected, const Eigen::Vector3d& base_lon_lat, double height_m) {
  const bool counts_from_ellipsoid = projected.has_vertical() && !projected.vertical();
  return counts_from_ellipsoid ? height_m : height_m + egm96_undulation_m(base_lon_lat.x(), base_lon_lat.y());
}

Eigen::Isometry3d rotated(const Eigen::Isometry3d& pose, const Eigen::Vector3d& position, double angle) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * pose.linear();
  result.translation() = position;
  return result;
}

}  // namespace

MapFrame MapFrame::at(const Crs& projected, const Eigen::Vector3d& origin) {
  if (!projected.is_projected())
    throw CrsError("the map frame needs a projected coordinate reference system, not " + projected.human_name());
  const Crs base = projected.geographic_base();
  const Eigen::Vector3d lon_lat = base_position(projected, origin);
  const double height_unit_m = signed_height_unit_m(projected);
  const double height_m = ellipsoidal_height_m(projected, lon_lat, origin.z() * height_unit_m);
  const double k_0 = 1 + height_m / gaussian_radius_m(base, lon_lat.y());
  const Crs frame = Crs::transverse_mercator(base, lon_lat.y(), lon_lat.x(), k_0);

  MapFrame result;
  result.georeference_.emplace(Georeference{Transformer(projected.horizontal(), frame), Transformer(frame, base), projected,
                                            height_unit_m, GeoPoint{lon_lat.y(), lon_lat.x(), height_m}, k_0});
  const LonLatArea area{lon_lat.x(), lon_lat.y(), lon_lat.x(), lon_lat.y()};
  try {
    result.map_to_wgs84_.emplace(frame, Crs::parse("EPSG:4326"), area);
  } catch (const CrsError&) {
    // A frame on an unknown datum maps as well; to_lon_lat says so when it is asked for.
  }
  return result;
}

MapFrame MapFrame::local() { return MapFrame(); }

bool MapFrame::georeferenced() const { return georeference_.has_value(); }

const MapFrame::Georeference& MapFrame::georeference() const {
  if (!georeference_) throw CrsError("the map is a local metric frame without georeference; give the prior's --prior-crs");
  return *georeference_;
}

const Crs& MapFrame::projected() const { return georeference().projected; }
const Crs& MapFrame::crs() const { return georeference().projected_to_map.target(); }
GeoPoint MapFrame::origin() const { return georeference().origin; }
double MapFrame::scale_factor() const { return georeference().scale_factor; }
std::string MapFrame::definition() const { return crs().proj_string(); }

void MapFrame::to_map(std::span<Eigen::Vector3d> projected_points) const {
  if (!georeference_) return;
  georeference_->projected_to_map.forward(projected_points);
  if (georeference_->height_unit_m == 1) return;
  for (Eigen::Vector3d& point : projected_points) point.z() *= georeference_->height_unit_m;
}

void MapFrame::to_projected(std::span<Eigen::Vector3d> map_points) const {
  if (!georeference_) return;
  georeference_->projected_to_map.inverse(map_points);
  if (georeference_->height_unit_m == 1) return;
  for (Eigen::Vector3d& point : map_points) point.z() /= georeference_->height_unit_m;
}

void MapFrame::to_lon_lat(std::span<Eigen::Vector3d> map_points) const {
  const Crs& frame = crs();
  if (!map_to_wgs84_) throw CrsError("no exact transformation is known from " + frame.geographic_base().human_name() + " to WGS 84");
  map_to_wgs84_->forward(map_points);
}

Eigen::Vector3d MapFrame::to_map(const Eigen::Vector3d& projected_point) const {
  Eigen::Vector3d point = projected_point;
  to_map(std::span(&point, 1));
  return point;
}

Eigen::Vector3d MapFrame::to_projected(const Eigen::Vector3d& map_point) const {
  Eigen::Vector3d point = map_point;
  to_projected(std::span(&point, 1));
  return point;
}

Eigen::Vector3d MapFrame::to_lon_lat(const Eigen::Vector3d& map_point) const {
  Eigen::Vector3d point = map_point;
  to_lon_lat(std::span(&point, 1));
  return point;
}

Eigen::Matrix2d MapFrame::projected_per_map(const Eigen::Vector3d& p_map) const {
  std::array<Eigen::Vector3d, 4> around;
  around.fill(p_map);
  around[0].x() += derivative_step_m, around[1].x() -= derivative_step_m;
  around[2].y() += derivative_step_m, around[3].y() -= derivative_step_m;
  georeference().projected_to_map.inverse(around);
  Eigen::Matrix2d jacobian;
  jacobian.col(0) = (around[0] - around[1]).head<2>() / (2 * derivative_step_m);
  jacobian.col(1) = (around[2] - around[3]).head<2>() / (2 * derivative_step_m);
  return jacobian;
}

double MapFrame::grid_rotation(const Eigen::Vector3d& p_map) const {
  const Eigen::Matrix2d j = projected_per_map(p_map);
  return std::atan2(j(1, 0) - j(0, 1), j(0, 0) + j(1, 1));
}

double MapFrame::grid_scale(const Eigen::Vector3d& p_map) const {
  return std::sqrt(std::abs(projected_per_map(p_map).determinant())) * projected().horizontal_unit_m();
}

Eigen::Isometry3d MapFrame::pose_to_map(const Eigen::Isometry3d& T_projected_sensor) const {
  if (!georeference_) return T_projected_sensor;
  const Eigen::Vector3d p_map = to_map(Eigen::Vector3d(T_projected_sensor.translation()));
  return rotated(T_projected_sensor, p_map, -grid_rotation(p_map));
}

Eigen::Isometry3d MapFrame::pose_to_projected(const Eigen::Isometry3d& T_map_sensor) const {
  if (!georeference_) return T_map_sensor;
  const Eigen::Vector3d p_map = T_map_sensor.translation();
  return rotated(T_map_sensor, to_projected(p_map), grid_rotation(p_map));
}

double MapFrame::convergence(const Eigen::Vector3d& p_map) const {
  const Transformer& map_to_base = georeference().map_to_base;
  const double step_deg = 1e-4;
  std::array<Eigen::Vector3d, 2> along_meridian;
  along_meridian.fill(map_to_base.forward(p_map));
  along_meridian[0].y() += step_deg, along_meridian[1].y() -= step_deg;
  map_to_base.inverse(along_meridian);
  const Eigen::Vector3d true_north = along_meridian[0] - along_meridian[1];
  return std::atan2(-true_north.x(), true_north.y());
}

}  // namespace priormap
