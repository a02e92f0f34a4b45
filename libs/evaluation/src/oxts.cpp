#include "oxts.hpp"

#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/map_frame.hpp>
#include <priormap/geodesy/transformer.hpp>

namespace priormap {

void to_utm(const std::vector<OxtsPose>& oxts, Trajectory& trajectory) {
  const GeoPoint& first = oxts.front().position;
  const Crs utm = Crs::utm_zone(first.lon_deg, first.lat_deg);
  const Transformer to_grid(Crs::parse("EPSG:4326"), utm);
  const auto on_grid = [&](const GeoPoint& p) { return to_grid.forward(Eigen::Vector3d(p.lon_deg, p.lat_deg, p.height_m)); };
  const MapFrame map = MapFrame::at(utm, on_grid(first));
  for (const OxtsPose& o : oxts) {
    const Eigen::Vector3d p_map = map.to_map(on_grid(o.position));
    const double yaw_map_rad = o.yaw_rad + map.convergence(p_map);
    Eigen::Isometry3d T_map_body = Eigen::Isometry3d::Identity();
    T_map_body.linear() = (Eigen::AngleAxisd(yaw_map_rad, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(o.pitch_rad, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(o.roll_rad, Eigen::Vector3d::UnitX())).toRotationMatrix();
    T_map_body.translation() = p_map;
    trajectory.poses.push_back(map.pose_to_projected(T_map_body));
  }
  trajectory.crs = utm.name();
}

}  // namespace priormap
