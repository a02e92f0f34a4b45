#include <priormap/mapping/start.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/mapping/prior_window.hpp>

namespace priormap {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;

void check(const InitialPose& initial, const PriorPoints* prior) {
  const bool has_pose = !initial.pose.empty(), has_place = !initial.lon_lat_deg.empty();
  if (has_pose && has_place) throw UsageError("--initial-pose and --initial-lonlat say the same thing: give one of them");
  if (has_pose && initial.pose.size() != 7)
    throw UsageError("--initial-pose takes seven numbers x,y,z,qx,qy,qz,qw, not " + std::to_string(initial.pose.size()));
  if (has_place && initial.lon_lat_deg.size() != 2) throw UsageError("--initial-lonlat takes two numbers, longitude and latitude");
  if (has_place && (std::abs(initial.lon_lat_deg[0]) > 180 || std::abs(initial.lon_lat_deg[1]) > 90))
    throw UsageError("--initial-lonlat: longitude lies in [-180, 180], latitude in [-90, 90], in this order");
  if (prior && !has_pose && !has_place) throw UsageError("--prior needs to know where the drive starts: give --initial-pose or --initial-lonlat");
  if (has_place && prior && !prior->crs()) throw UsageError("the prior is a local frame without CRS: give --initial-pose in that frame, or its CRS by --prior-crs");
  if (initial.yaw_deg && initial.heading_deg) throw UsageError("--initial-yaw and --initial-heading say the same thing: give one of them");
  if (has_place && !initial.yaw_deg && !initial.heading_deg) throw UsageError("--initial-lonlat needs a direction: give --initial-yaw or --initial-heading");
  if (!has_place && (initial.yaw_deg || initial.heading_deg || initial.height_m))
    throw UsageError("--initial-yaw, --initial-heading and --initial-height go with --initial-lonlat");
}

Eigen::Isometry3d pose_of(const std::vector<double>& v) {
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); }) || std::abs(q.norm() - 1) > 1e-2)
    throw UsageError("--initial-pose: qx,qy,qz,qw is no unit quaternion");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
  return T;
}

/// The lower envelope of heights: low enough to be ground, not so low as to be an outlier.
double low_quantile(std::vector<double> heights) {
  const auto at = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 20);
  std::nth_element(heights.begin(), at, heights.end());
  return *at;
}

/// Height of the ground under the sensor, in the sensor frame.
double ground_below_sensor(const PointCloud& scan) {
  std::vector<double> heights;
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.position(i).head<2>().norm() < 20) heights.push_back(scan.position(i).z());
  if (heights.empty()) throw Error("the first scan has no points within 20 m of the sensor: give --initial-height");
  return low_quantile(std::move(heights));
}

/// Of the prior near a place, in its heights; nothing where it has no points within 100 m.
std::optional<double> ground_near(const PriorPoints& prior, const Eigen::Vector3d& place) {
  for (const double radius_m : {20.0, 50.0, 100.0}) {
    const double r = radius_m / prior.units().horizontal_m;
    std::vector<double> heights;
    for (const TileKey key : prior.tiles_within({place.x() - r, place.y() - r, place.x() + r, place.y() + r})) {
      const PointCloud tile = prior.load(key);
      for (std::size_t i = 0; i < tile.size(); ++i)
        if ((tile.position(i) - place).head<2>().norm() < r) heights.push_back(tile.position(i).z());
    }
    if (!heights.empty()) return low_quantile(std::move(heights));
  }
  return std::nullopt;
}

double prior_ground(const PriorPoints& prior, const Eigen::Vector3d& place) {
  if (const auto ground = ground_near(prior, place)) return *ground;
  throw Error("the prior has no points within 100 m of --initial-lonlat to take the height of the ground from: give --initial-height");
}

std::string readable_distance(double distance_m) {
  char text[32];
  std::snprintf(text, sizeof(text), distance_m < 10000 ? "%.0f m" : "%.0f km", distance_m < 10000 ? distance_m : distance_m / 1000);
  return text;
}

bool is_near(const PriorPoints& prior, const Eigen::Vector3d& place, double radius_m) { return place.allFinite() && distance_to_prior_m(prior, place) <= radius_m; }

/// The place that two numbers mean when they are taken in the other order.
struct Swapped {
  Eigen::Vector3d place;
  std::string remedy;
};

void check_near(const PriorPoints& prior, const Eigen::Vector3d& place, double radius_m, const Swapped& swapped) {
  if (is_near(prior, place, radius_m)) return;
  const std::string usual_remedy = "check --initial-pose or --initial-lonlat, or start later with --start";
  throw Error("prior and scans are in different places: the initial pose is " + (place.allFinite() ? readable_distance(distance_to_prior_m(prior, place)) : "out of reach") +
              " from the nearest tile of " + prior.identity().name + "; " + (is_near(prior, swapped.place, radius_m) ? swapped.remedy : usual_remedy));
}

Start start_at_lon_lat(const InitialPose& initial, const PriorPoints* prior, const PointCloud& first_scan, double prior_radius_m) {
  const double lon = initial.lon_lat_deg[0], lat = initial.lon_lat_deg[1];
  const Crs crs = prior ? *prior->crs() : Crs::utm_zone(lon, lat);
  const Transformer from_lon_lat(Crs::parse("EPSG:4326"), crs.horizontal());
  Eigen::Vector3d place = from_lon_lat.forward(Eigen::Vector3d(lon, lat, 0));
  const Swapped swapped{from_lon_lat.forward(Eigen::Vector3d(lat, lon, 0)), "swap the numbers of --initial-lonlat: it takes the longitude first"};
  if (prior) check_near(*prior, place, prior_radius_m, swapped);
  if (!place.allFinite()) throw CrsError("--initial-lonlat lies outside the area of " + crs.name());
  const double ground = initial.height_m || !prior ? 0 : prior_ground(*prior, place) * crs.vertical_unit_m();
  place.z() = initial.height_m ? *initial.height_m : prior ? ground - ground_below_sensor(first_scan) : 0;

  Start start{MapFrame::at(crs, place), crs, Eigen::Isometry3d::Identity(), initial.height_m.has_value()};
  const Eigen::Vector3d p_map = start.frame.to_map(place);
  const double yaw_true = rad_per_deg * (initial.yaw_deg ? *initial.yaw_deg : 90 - *initial.heading_deg);
  start.T_map_sensor.linear() = Eigen::AngleAxisd(yaw_true + start.frame.convergence(p_map), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  start.T_map_sensor.translation() = p_map;
  return start;
}

Start start_at_pose(const InitialPose& initial, const PriorPoints* prior, double prior_radius_m) {
  const Eigen::Isometry3d T = initial.pose.empty() ? Eigen::Isometry3d::Identity() : pose_of(initial.pose);
  const Swapped swapped{{T.translation().y(), T.translation().x(), T.translation().z()}, "swap the first two numbers of --initial-pose: it takes the easting first"};
  if (prior) check_near(*prior, T.translation(), prior_radius_m, swapped);
  if (!prior || !prior->crs()) return {MapFrame::local(), std::nullopt, T, !initial.pose.empty()};
  const MapFrame frame = MapFrame::at(*prior->crs(), T.translation());
  return {frame, prior->crs(), frame.pose_to_map(T), !initial.pose.empty()};
}

}  // namespace

Start find_start(const InitialPose& initial, const PriorPoints* prior, const PointCloud& first_scan, double prior_radius_m) {
  check(initial, prior);
  return initial.lon_lat_deg.empty() ? start_at_pose(initial, prior, prior_radius_m) : start_at_lon_lat(initial, prior, first_scan, prior_radius_m);
}

void warn_of_height(const Start& start, const PriorPoints& prior, const Events& events) {
  constexpr double usual_m = 20;   // bridges apart
  const Eigen::Vector3d p_map = start.T_map_sensor.translation();
  const Eigen::Vector3d place = start.crs ? start.frame.to_projected(p_map) : p_map;
  const auto ground = ground_near(prior, place);
  if (!ground) return;
  const double above_m = p_map.z() - *ground * prior.units().vertical_m;
  if (std::abs(above_m) <= usual_m) return;
  const bool undeclared = start.crs && !start.crs->has_vertical();
  events.warn("the start lies " + readable_distance(std::abs(above_m)) + (above_m > 0 ? " above" : " below") + " the ground of " + prior.identity().name + " there" +
              (undeclared ? ", whose heights are undeclared: make the prior with heights that the pose shares (--terrain, --crs H+V)" : ": check its height") +
              ", or let the prior give it with --initial-lonlat without --initial-height");
}

}  // namespace priormap
