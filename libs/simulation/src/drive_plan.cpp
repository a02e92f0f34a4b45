#include "drive_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/option_crs.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/simulation/street_graph.hpp>
#include <priormap/sources/height_raster.hpp>

#include "mesh_parts.hpp"
#include "osm_town.hpp"
#include "polyline.hpp"

namespace priormap {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr std::size_t default_scans = 300;
constexpr double town_margin_m = 90;   // beyond streets and track: nearly as far as the sensor sees

Crs projected_crs(const RouteOptions& route) {
  Crs crs = option_crs("--crs", route.crs);
  if (!crs.is_projected()) throw UsageError("--crs " + route.crs + " is not projected; name one such as EPSG:25832+7837");
  if (crs.horizontal_unit_m() != 1 || crs.vertical_unit_m() != 1)
    throw UsageError("--crs " + route.crs + " does not count in metres; name one that does, such as EPSG:25832+7837");
  return crs;
}

MapFrame frame_at(const RouteOptions& route, const Eigen::Vector2d& lon_lat) {
  const Crs crs = projected_crs(route);
  const Transformer from_lon_lat(Crs::parse("EPSG:4326"), crs.horizontal());
  Eigen::Vector3d origin = from_lon_lat.forward(Eigen::Vector3d(lon_lat.x(), lon_lat.y(), 0));
  if (!origin.allFinite()) throw CrsError("the drive's place lies outside of " + route.crs + "; name its zone with --crs");
  origin.z() = route.origin_height_m;
  return MapFrame::at(crs, origin);
}

MapFrame frame_at_origin(const RouteOptions& route) {
  constexpr double border_deg = 3;
  if (route.origin_lon_lat.size() != 2) throw UsageError("--origin takes LON,LAT");
  const double lon_deg = route.origin_lon_lat[0], lat_deg = route.origin_lon_lat[1];
  if (std::abs(lat_deg) > 90) throw UsageError("--origin: longitude lies in [-180, 180], latitude in [-90, 90], in this order");
  const std::optional<LonLatArea> area = projected_crs(route).area_of_use();
  if (area && area->degrees_outside({lat_deg, lon_deg, 0}) > border_deg) {
    const bool swapped_fits = area->degrees_outside({lon_deg, lat_deg, 0}) == 0;
    throw UsageError("--origin lies outside of " + route.crs + "; " + (swapped_fits ? "swap its numbers: it takes the longitude first" : "name the CRS of that place with --crs"));
  }
  return frame_at(route, {lon_deg, lat_deg});
}

/// Ground heights of a terrain model under the town, on a raster of 4 m.
std::vector<Eigen::Vector3d> ground_points(const std::string& terrain, const MapFrame& frame, const Bounds2& bounds) {
  constexpr double spacing_m = 4;
  const HeightRaster raster = HeightRaster::open(terrain, std::nullopt, frame.projected());
  std::vector<Eigen::Vector3d> points;
  for (double y = bounds.min_y; y < bounds.max_y; y += spacing_m)
    for (double x = bounds.min_x; x < bounds.max_x; x += spacing_m) {
      const Eigen::Vector3d projected = frame.to_projected(Eigen::Vector3d(x, y, 0));
      if (const auto height_m = raster.at(projected.x(), projected.y())) points.emplace_back(x, y, *height_m);
    }
  if (points.empty()) throw FormatError(terrain, "covers no part of the drive's town");
  return points;
}

Relief relief_of(const DriveOptions& options, const MapFrame& frame, const Bounds2& bounds) {
  if (options.route.terrain) return relief_through(ground_points(*options.route.terrain, frame, bounds), bounds);
  return rolling_relief(options.route.origin_height_m, options.town_options.relief_m, options.seed);
}

Bounds2 bounds_around(const TownPlan& plan) {
  Eigen::Vector2d low = plan.driven.front(), high = low;
  const auto include = [&](const Eigen::Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (const Eigen::Vector2d& p : plan.driven) include(p);
  for (const Street& street : plan.streets)
    for (const Eigen::Vector2d& p : street.line) include(p);
  // Whole metres: the ground's grid does not depend on the last digit of a coordinate.
  return {std::floor(low.x() - town_margin_m), std::floor(low.y() - town_margin_m), std::ceil(high.x() + town_margin_m), std::ceil(high.y() + town_margin_m)};
}

/// The recorded poses in `map`: the first one at its origin, turned to its direction there.
std::vector<Eigen::Isometry3d> recorded_in_map(const DriveOptions& options, const RecordedPoses& recorded) {
  const Eigen::Vector3d start = recorded.poses.front().translation(), forward = recorded.poses.front().linear().col(0);
  // True north and map north agree at the frame's origin, where the first pose is.
  const double turn = options.route.start_yaw_deg * degree - std::atan2(forward.y(), forward.x());
  const Eigen::Isometry3d T_map_recorded = Eigen::Translation3d(0, 0, options.route.origin_height_m) *
                                           Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-start);
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Isometry3d& pose : recorded.poses) poses.push_back(T_map_recorded * pose);
  return poses;
}

/// The part of a track that is driven.
std::vector<TrackPoint> driven_part(const std::vector<TrackPoint>& track, const RouteOptions& route) {
  const auto first = static_cast<std::size_t>(route.first_scan);
  if (first >= track.size()) throw UsageError("--first " + std::to_string(first) + " lies beyond the trajectory's end");
  const std::size_t left = track.size() - first;
  const std::size_t count = route.num_scans == 0 ? left : std::min(left, static_cast<std::size_t>(route.num_scans));
  const auto begin = track.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

/// Where a kidnapped vehicle is missed; nothing: it is not kidnapped.
std::optional<Eigen::Vector2d> kidnapped_at(const DriveOptions& options, const std::vector<TrackPoint>& track) {
  if (options.kidnap.at_scan == 0) return std::nullopt;
  const auto at = static_cast<std::size_t>(options.kidnap.at_scan);
  if (at >= track.size())
    throw UsageError("--kidnap-at " + std::to_string(at) + " lies beyond the drive's " + std::to_string(track.size()) + " scans");
  if (options.kidnap.drives_on && at + static_cast<std::size_t>(options.kidnap.num_scans) > track.size())
    throw UsageError("--kidnap-drives-on: " + std::to_string(options.kidnap.num_scans) + " scans from " + std::to_string(at) + " on are more than the drive's " + std::to_string(track.size()));
  return track[at].position;
}

/// The stretch of a track that starts farthest from a place.
std::vector<TrackPoint> farthest_part(const std::vector<TrackPoint>& track, const Eigen::Vector2d& place, int num_scans) {
  if (track.size() < static_cast<std::size_t>(num_scans))
    throw UsageError("--kidnap-scans " + std::to_string(num_scans) + " is more than the trajectory has");
  const auto last_begin = track.end() - num_scans + 1;
  const auto begin = std::max_element(track.begin(), last_begin, [&](const TrackPoint& a, const TrackPoint& b) {
    return (a.position - place).squaredNorm() < (b.position - place).squaredNorm();
  });
  return {begin, begin + num_scans};
}

DrivePlan plan_recorded(const DriveOptions& options) {
  const RecordedPoses recorded = read_recorded_poses(*options.trajectory, options.route.trajectory_axes);
  const std::vector<Eigen::Isometry3d> poses = recorded_in_map(options, recorded);
  DrivePlan plan{frame_at_origin(options.route), {}, {}, {}, {}};
  std::vector<TrackPoint> track;
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d forward = poses[i].linear().col(0);
    const double stamp_s = recorded.stamps_s.empty() ? static_cast<double>(i) / scan_rate_hz(options) : recorded.stamps_s[i];
    track.push_back({stamp_s, poses[i].translation().head<2>(), std::atan2(forward.y(), forward.x())});
    positions.push_back(poses[i].translation());
  }
  // The town stands around the whole trajectory, whichever part of it is driven.
  plan.track = driven_part(track, options.route);
  if (const auto place = kidnapped_at(options, plan.track)) plan.elsewhere = farthest_part(track, *place, options.kidnap.num_scans);
  plan.town.driven = line_of(track);
  plan.town.streets = streets_of_track(plan.town.driven);
  plan.town.bounds = bounds_around(plan.town);
  plan.town.relief = options.route.terrain ? relief_of(options, plan.frame, plan.town.bounds) : relief_through(positions, plan.town.bounds);
  return plan;
}

void shift(StreetGraph& graph, const Eigen::Vector2d& by) {
  for (Eigen::Vector2d& node : graph.nodes) node += by;
  for (StreetGraph::Edge& edge : graph.edges)
    for (Eigen::Vector2d& p : edge.line) p += by;
}

std::vector<TrackPoint> drive_from(const Eigen::Vector2d& start, std::size_t num_scans, bool there_and_back, const DriveOptions& options,
                                   const StreetGraph& graph) {
  constexpr double lane_share = 0.3, spare_m = 50;
  const DriveSpeed speed{options.route.speed_mps, scan_rate_hz(options)};
  const double length_m = static_cast<double>(num_scans) / speed.rate_hz * speed.speed_mps + (there_and_back ? 0 : spare_m);
  const auto line = route_along(graph, start, length_m, there_and_back, options.seed);
  return drive_along(line, lane_share * graph.edges.front().half_width_m, speed, num_scans);
}

std::vector<TrackPoint> drive_route(const DriveOptions& options, const StreetGraph& graph) {
  const std::size_t count = options.route.num_scans == 0 ? default_scans : static_cast<std::size_t>(options.route.num_scans);
  return drive_from(Eigen::Vector2d::Zero(), count, options.route.there_and_back, options, graph);
}

/// A kidnapped vehicle's route along the streets, from the node farthest from where it is missed.
std::vector<TrackPoint> drive_elsewhere(const DriveOptions& options, const std::vector<TrackPoint>& track, const StreetGraph& graph) {
  const auto place = kidnapped_at(options, track);
  if (!place) return {};
  const auto farthest = std::max_element(graph.nodes.begin(), graph.nodes.end(), [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (a - *place).squaredNorm() < (b - *place).squaredNorm();
  });
  return drive_from(*farthest, static_cast<std::size_t>(options.kidnap.num_scans), false, options, graph);
}

DrivePlan plan_generated(const DriveOptions& options) {
  StreetGraph graph = grid_streets(options.route.town_size_m, options.seed);
  shift(graph, -drive_route(options, graph).front().position);   // the frame's origin is the first pose
  DrivePlan plan{frame_at_origin(options.route), {}, drive_route(options, graph), {}, {}};
  plan.elsewhere = drive_elsewhere(options, plan.track, graph);
  plan.town.driven = line_of(plan.track);
  plan.town.streets = streets_of(graph);
  plan.town.bounds = bounds_around(plan.town);
  plan.town.relief = relief_of(options, plan.frame, plan.town.bounds);
  return plan;
}

/// The frame `map` whose origin is a position in another frame.
MapFrame frame_at(const MapFrame& other, const Eigen::Vector2d& p_other, double height_m) {
  return MapFrame::at(other.projected(), other.to_projected(Eigen::Vector3d(p_other.x(), p_other.y(), height_m)));
}

std::vector<TrackPoint> moved(const std::vector<TrackPoint>& track, const MapFrame& from, const MapFrame& to) {
  std::vector<TrackPoint> result;
  for (const TrackPoint& point : track) {
    const Eigen::Isometry3d T_from = upright({point.position.x(), point.position.y(), 0}, point.yaw);
    const Eigen::Isometry3d T_to = to.pose_to_map(from.pose_to_projected(T_from));
    result.push_back({point.stamp_s, T_to.translation().head<2>(), std::atan2(T_to(1, 0), T_to(0, 0))});
  }
  return result;
}

DrivePlan plan_in_osm_town(const DriveOptions& options, int threads) {
  if (options.trajectory) throw UsageError("--trajectory goes with a generated town; in an OSM town the drive follows the streets");
  const OsmTown osm(options.town, threads);
  // The route decides where the first pose is, and with it the frame: find it in a frame nearby.
  const MapFrame nearby = frame_at(options.route, osm.centre_lon_lat());
  const StreetGraph graph = osm.streets(nearby, osm.buildings(nearby));
  const std::vector<TrackPoint> track = drive_route(options, graph);
  DrivePlan plan{frame_at(nearby, track.front().position, options.route.origin_height_m), {}, {}, {}, {}};
  plan.track = moved(track, nearby, plan.frame);
  plan.elsewhere = moved(drive_elsewhere(options, track, graph), nearby, plan.frame);
  plan.buildings = osm.buildings(plan.frame);
  plan.town.driven = line_of(plan.track);
  plan.town.streets = streets_of(osm.streets(plan.frame, *plan.buildings));
  plan.town.bounds = bounds_around(plan.town);
  plan.town.relief = relief_of(options, plan.frame, plan.town.bounds);
  return plan;
}

}  // namespace

std::vector<Eigen::Vector2d> line_of(const std::vector<TrackPoint>& track) {
  std::vector<Eigen::Vector2d> line;
  for (const TrackPoint& point : track) line.push_back(point.position);
  return line;
}

double scan_rate_hz(const DriveOptions& options) { return options.route.rate_hz.value_or(lidar_model(options.sensor).rate_hz); }

DrivePlan plan_drive(const DriveOptions& options, int threads) {
  if (options.route.trajectory_axes != "camera" && options.route.trajectory_axes != "lidar")
    throw UsageError("--trajectory-axes is camera or lidar, not '" + options.route.trajectory_axes + "'");
  DrivePlan plan = options.town != "generated" ? plan_in_osm_town(options, threads)
                   : options.trajectory ? plan_recorded(options) : plan_generated(options);
  plan.town.rural = middle_of(line_of(plan.track), options.route.rural_m);
  if (plan.track.size() < 2) throw UsageError("a drive needs two scans at least");
  return plan;
}

}  // namespace priormap
