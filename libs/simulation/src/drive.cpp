#include <priormap/simulation/drive.hpp>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <fstream>
#include <numbers>

#include <nlohmann/json.hpp>

#include <priormap/core/error.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/core/version.hpp>
#include <priormap/simulation/random.hpp>
#include <priormap/simulation/traffic.hpp>

#include "drive_plan.hpp"
#include "osm_town.hpp"
#include "polyline.hpp"
#include "stream.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  char text[512];
  va_list values;
  va_start(values, pattern);
  std::vsnprintf(text, sizeof text, pattern, values);
  va_end(values);
  return text;
}

/// A file written in one go; a full disk is an error.
void write_file(const fs::path& file, const void* bytes, std::size_t size) {
  std::ofstream out(file, std::ios::binary);
  out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  out.close();
  if (!out) throw IoError(file, "cannot be written (disk full?)");
}

void write_text(const fs::path& file, const std::string& text) { write_file(file, text.data(), text.size()); }

std::string scan_name(std::size_t index) { return format("%06zu", index); }

std::string quaternion_text(const Eigen::Matrix3d& rotation, char separator) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return format("%.9f%c%.9f%c%.9f%c%.9f", q.x(), separator, q.y(), separator, q.z(), separator, q.w());
}

/// Something driven in one go.
struct Stretch {
  DrivePath path;
  Traffic traffic;
};

/// Which scan of which stretch.
struct Shot {
  const Stretch* stretch;
  std::size_t index;
};

/// The drive with the scans of another street spliced in before its scan number `at`, or in place of as many from there on.
std::vector<Shot> splice(const Stretch& drive, const Stretch& elsewhere, const KidnapOptions& kidnap) {
  const auto at = static_cast<std::size_t>(kidnap.at_scan);
  const std::size_t goes_on = at + (kidnap.drives_on ? elsewhere.path.size() : 0);
  std::vector<Shot> shots;
  for (std::size_t i = 0; i < drive.path.size(); ++i) {
    if (i == at)
      for (std::size_t k = 0; k < elsewhere.path.size(); ++k) shots.push_back({&elsewhere, k});
    if (i < at || i >= goes_on) shots.push_back({&drive, i});
  }
  return shots;
}

/// Poses of the scans as they come, at stamps that go on through a splice: those of the scans that others took the place of, or a period apart.
DrivePath recorded_path(const std::vector<Shot>& shots, const Stretch& drive, const Stretch& elsewhere, double period_s, bool drives_on) {
  DrivePath recorded;
  if (drives_on) {
    recorded.stamps_s = drive.path.stamps_s;
    for (const Shot& shot : shots) recorded.poses.push_back(shot.stretch->path.poses[shot.index]);
    return recorded;
  }
  double away_s = 0;
  for (const Shot& shot : shots) {
    const bool is_elsewhere = shot.stretch == &elsewhere;
    recorded.stamps_s.push_back(is_elsewhere ? recorded.stamps_s.back() + period_s : shot.stretch->path.stamps_s[shot.index] + away_s);
    recorded.poses.push_back(shot.stretch->path.poses[shot.index]);
    if (is_elsewhere) away_s += period_s;
  }
  return recorded;
}

/// @param elsewhere  stretch whose scans the last column marks; an empty one: no such column
void write_trajectory(const fs::path& file, const DrivePath& path, const std::vector<Shot>& shots, const Stretch& elsewhere, const MapFrame& frame) {
  const bool marked = elsewhere.path.size() > 0;
  std::vector<Eigen::Vector3d> lon_lat;
  for (const auto& pose : path.poses) lon_lat.push_back(pose.translation());
  frame.to_lon_lat(lon_lat);
  std::string text = std::string("index,stamp_s,x_m,y_m,z_m,qx,qy,qz,qw,lon_deg,lat_deg") + (marked ? ",kidnapped\n" : "\n");
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Isometry3d T_projected_sensor = frame.pose_to_projected(path.poses[i]);
    const Eigen::Vector3d& p = T_projected_sensor.translation();
    text += format("%zu,%.6f,%.4f,%.4f,%.4f,", i, path.stamps_s[i], p.x(), p.y(), p.z()) + quaternion_text(T_projected_sensor.linear(), ',') +
            format(",%.10f,%.10f", lon_lat[i].x(), lon_lat[i].y());
    text += marked ? format(",%d\n", shots[i].stretch == &elsewhere) : "\n";
  }
  write_text(file, text);
}

void write_kitti_poses(const fs::path& file, const DrivePath& path, const MapFrame& town_frame, const MapFrame& map) {
  std::string text;
  for (const Eigen::Isometry3d& pose : path.poses) {
    const Eigen::Isometry3d T_map_sensor = map.pose_to_map(town_frame.pose_to_projected(pose));
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) text += format("%.9e", T_map_sensor(r, c)) + (r == 2 && c == 3 ? '\n' : ' ');
  }
  write_text(file, text);
}

void write_times(const fs::path& file, const DrivePath& path) {
  std::string text;
  for (const double stamp_s : path.stamps_s) text += format("%.6f\n", stamp_s);
  write_text(file, text);
}

/// The first pose as a user would know it: moved and turned by the start error, in a direction drawn by lot.
void write_initial_pose(const fs::path& file, const DrivePath& path, const MapFrame& frame, const DriveOptions& options) {
  Random random(options.seed, {stream::initial_pose});
  const double direction = random.uniform(0, 2 * std::numbers::pi), sense = random.chance(0.5) ? 1 : -1;
  Eigen::Isometry3d start = path.poses.front();
  start.translation() += options.route.start_error_m * Eigen::Vector3d(std::cos(direction), std::sin(direction), 0);
  start.linear() = Eigen::AngleAxisd(sense * options.route.start_error_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitZ()) * start.linear();
  const Eigen::Isometry3d T_projected_sensor = frame.pose_to_projected(start);
  const Eigen::Vector3d& p = T_projected_sensor.translation();
  write_text(file, format("%.4f,%.4f,%.4f,", p.x(), p.y(), p.z()) + quaternion_text(T_projected_sensor.linear(), ',') + "\n");
}

void write_frame(const fs::path& file, const MapFrame& frame, const DriveOptions& options) {
  const GeoPoint origin = frame.origin();
  const Json json{{"crs", frame.projected().name()},
                  {"map_frame", {{"proj", frame.definition()},
                                 {"origin_lon_deg", origin.lon_deg},
                                 {"origin_lat_deg", origin.lat_deg},
                                 {"scale_factor", frame.scale_factor()}}},
                  {"sensor", options.sensor}};
  write_text(file, json.dump(2) + "\n");
}

void write_building_errors(const fs::path& file, const Town& town, const std::vector<BuildingError>& errors) {
  std::string text = "id,missing,shift_x_m,shift_y_m,rotation_deg,has_height,has_levels,height_error_m,true_height_m,ground_z_m,surveyed,x_map_m,y_map_m\n";
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Building& building = town.buildings[i];
    const BuildingError& error = errors[i];
    text += building.id + format(",%d,%.4f,%.4f,%.5f,%d,%d,%.3f,%.3f,%.3f,%d,%.3f,%.3f\n", error.missing, error.shift_m.x(), error.shift_m.y(),
                                 error.rotation * 180 / std::numbers::pi, error.has_height_tag, error.has_levels_tag, error.height_error_m,
                                 building.height_m(), building.ground_z, building.surveyed, building.outline.exterior[0].x(),
                                 building.outline.exterior[0].y());
  }
  write_text(file, text);
}

template <class Options>
Json json_of(Options options) {
  Json json = Json::object();
  auto visit = [&](const std::string& name, const auto& value, const OptionField&) {
    if constexpr (requires { value.has_value(); }) {
      if (value) json[name] = *value;
    } else {
      json[name] = value;
    }
  };
  options.describe(visit);
  return json;
}

Json manifest(const DriveOptions& options, const Town& town, const DriveSummary& summary) {
  Json json{{"generator", "drivesim " + std::string(version)}, {"town", options.town == "generated" ? options.town : fs::path(options.town).filename().string()}};
  if (options.trajectory) json["trajectory"] = fs::path(*options.trajectory).filename().string();
  json["sensor"] = options.sensor;
  json["seed"] = options.seed;
  json["options"] = {{"route", json_of(options.route)}, {"town", json_of(options.town_options)}, {"source_errors", json_of(options.errors)},
                     {"platform", json_of(options.platform)}, {"lidar", json_of(options.noise)}};
  if (options.kidnap.at_scan > 0) json["options"]["kidnap"] = json_of(options.kidnap);
  json["world"] = {{"buildings", town.buildings.size()}, {"buildings_missing_in_osm", summary.num_missing},
                   {"buildings_without_height_in_osm", summary.num_default_height}, {"trees", town.trees.size()}, {"poles", town.poles.size()},
                   {"parked_cars", town.parked_cars.size()}, {"barriers", town.barriers.size()}};
  json["drive"] = {{"scans", summary.num_scans}, {"points", summary.num_points}, {"length_m", std::round(summary.length_m * 1000) / 1000}};
  return json;
}

/// KITTI's layout: x, y, z, intensity as float32.
void write_scan(const fs::path& directory, std::size_t index, const PointCloud& scan) {
  std::vector<float> values;
  values.reserve(4 * scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) values.insert(values.end(), {scan.xyz[i].x(), scan.xyz[i].y(), scan.xyz[i].z(), scan.intensity[i]});
  write_file(directory / "velodyne" / (scan_name(index) + ".bin"), values.data(), values.size() * sizeof(float));
  if (!scan.time_s.empty())
    write_file(directory / "point_times" / (scan_name(index) + ".f32"), scan.time_s.data(), scan.time_s.size() * sizeof(float));
}

void write_scans(const fs::path& directory, const Lidar& lidar, const std::vector<Shot>& shots, const Terrain& terrain, int threads,
                 const Events& events, DriveSummary& summary) {
  const auto start = std::chrono::steady_clock::now();
  std::atomic<std::size_t> num_points = 0;
  ordered_pipeline(shots.size(), threads, static_cast<std::size_t>(4 * threads),
                   [&](std::size_t i) {
                     const Shot& shot = shots[i];
                     const std::vector<Car> cars = shot.stretch->traffic.at(shot.index, terrain);
                     const PointCloud scan = lidar.scan(shot.stretch->path, shot.index, &cars);
                     write_scan(directory, i, scan);
                     num_points += scan.size();
                   },
                   [&](std::size_t i) { events.advance("scans", static_cast<double>(i + 1) / static_cast<double>(shots.size())); });
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  summary.num_scans = shots.size();
  summary.num_points = num_points;
  summary.simulate_ms_per_scan = elapsed.count() / static_cast<double>(shots.size());
}

bool source_says_height(const Building& building, const BuildingError& error) {
  if (building.source) return building.source->height_m || building.source->levels;
  return error.has_height_tag || error.has_levels_tag;
}

Town build_town(const DrivePlan& plan, const DriveOptions& options) {
  if (!plan.buildings) return generate_town(plan.town, options.town_options, options.seed);
  Town town{lay_ground(plan.town, options.seed), plan.town.streets, *plan.buildings, {}, {}, {}, {}};
  raise_buildings(town.buildings, town.terrain, options.errors, options.town_options.unsurveyed_share, options.seed);
  furnish(town, plan.town, options.town_options, options.seed);
  return town;
}

}  // namespace

DriveSummary simulate_drive(const DriveOptions& options, const fs::path& output, Overwrite overwrite, int threads, const Events& events) {
  AtomicDirectory directory(output, overwrite, "drive.json");
  const fs::path& root = directory.temporary_path();
  for (const char* folder : {"velodyne", "truth", "sources"}) fs::create_directory(root / folder);
  if (options.noise.motion_distortion) fs::create_directory(root / "point_times");

  const DrivePlan plan = plan_drive(options, threads);
  const Town town = build_town(plan, options);
  const std::vector<Eigen::Vector2d> driven = line_of(plan.track);
  const std::vector<BuildingError> errors = draw_errors(town, driven, options.errors, options.seed);
  const auto drive_stretch = [&](const std::vector<TrackPoint>& track) {
    return Stretch{ride(track, town.terrain, options.platform, options.seed), Traffic(track, options.route.traffic_spacing_m, options.seed)};
  };
  const Stretch drive = drive_stretch(plan.track), elsewhere = drive_stretch(plan.elsewhere);
  const std::vector<Shot> shots = splice(drive, elsewhere, options.kidnap);
  const DrivePath path = recorded_path(shots, drive, elsewhere, 1 / scan_rate_hz(options), options.kidnap.drives_on);
  // The town's frame lies under the first wheel track; the frame `map` of the outputs at the first sensor pose, some centimetres off when it tilts.
  const MapFrame map = MapFrame::at(plan.frame.projected(), plan.frame.to_projected(path.poses.front().translation()));
  events.inform(format("%zu buildings, %zu trees, %zu parked cars along %.0f m of drive", town.buildings.size(), town.trees.size(),
                       town.parked_cars.size(), length(driven)));
  const World world = build_world(town, options.seed);

  write_osm(root / "sources" / "town.osm.pbf", osm_of(town, errors, plan.frame));
  const Crs& crs = plan.frame.projected();
  write_geotiff(root / "sources" / "dsm.tif", surface_model(world, town, driven, plan.frame, options.errors, options.seed), crs);
  write_geotiff(root / "sources" / "dtm.tif", terrain_model(town, driven, plan.frame, options.errors, options.seed), crs);
  write_times(root / "times.txt", path);
  write_trajectory(root / "truth" / "trajectory.csv", path, shots, elsewhere, plan.frame);
  write_kitti_poses(root / "truth" / "poses_kitti.txt", path, plan.frame, map);
  write_initial_pose(root / "truth" / "initial_pose.txt", path, plan.frame, options);
  write_frame(root / "truth" / "frame.json", map, options);
  write_building_errors(root / "truth" / "buildings.csv", town, errors);

  DriveSummary summary;
  summary.length_m = length(driven);
  summary.num_buildings = town.buildings.size();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    summary.num_missing += errors[i].missing;
    summary.num_default_height += !errors[i].missing && !source_says_height(town.buildings[i], errors[i]);
  }
  LidarModel model = lidar_model(options.sensor);
  model.rate_hz = scan_rate_hz(options);
  write_scans(root, Lidar(world, std::move(model), options.noise, options.seed), shots, town.terrain, threads, events, summary);
  write_text(root / "drive.json", manifest(options, town, summary).dump(2) + "\n");
  directory.commit();
  return summary;
}

}  // namespace priormap
