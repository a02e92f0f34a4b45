#include <priormap/simulation/drive_path.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include <priormap/core/error.hpp>
#include <priormap/simulation/random.hpp>

#include "steering.hpp"
#include "stream.hpp"

namespace priormap {
namespace {

/// Sums of sines of neighbouring frequencies: no two seconds alike.
class Wobble {
 public:
  Wobble(const PlatformOptions& platform, std::uint64_t seed) {
    Random random(seed, {stream::wobble});
    const double amplitude = platform.wobble_deg * std::numbers::pi / 180;
    for (auto& axis : axes_)
      for (Wave& wave : axis)
        wave = {2 * std::numbers::pi * platform.wobble_hz * random.uniform(0.5, 1.3), random.uniform(0, 2 * std::numbers::pi),
                amplitude / static_cast<double>(axis.size())};
  }
  double pitch(double t) const { return at(axes_[0], t); }
  double roll(double t) const { return at(axes_[1], t); }

 private:
  struct Wave {
    double rate, phase, amplitude;
  };
  static double at(const std::array<Wave, 3>& waves, double t) {
    double sum = 0;
    for (const Wave& wave : waves) sum += wave.amplitude * std::sin(wave.rate * t + wave.phase);
    return sum;
  }
  std::array<std::array<Wave, 3>, 2> axes_;
};

Eigen::Isometry3d vehicle_on_ground(const TrackPoint& point, const Terrain& terrain) {
  constexpr double half_wheelbase_m = 1.35, half_track_m = 0.75;
  const Eigen::Vector2d forward(std::cos(point.yaw), std::sin(point.yaw)), left(-forward.y(), forward.x());
  const auto ground = [&](double f, double l) { return terrain.height(point.position + f * forward + l * left); };
  const double front_left = ground(half_wheelbase_m, half_track_m), front_right = ground(half_wheelbase_m, -half_track_m);
  const double back_left = ground(-half_wheelbase_m, half_track_m), back_right = ground(-half_wheelbase_m, -half_track_m);
  const double rise_forward = (front_left + front_right - back_left - back_right) / (4 * half_wheelbase_m);
  const double rise_left = (front_left - front_right + back_left - back_right) / (4 * half_track_m);
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  T_map_vehicle.translation() << point.position, (front_left + front_right + back_left + back_right) / 4;
  T_map_vehicle.linear() = (Eigen::AngleAxisd(point.yaw, Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(-std::atan(rise_forward), Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(std::atan(rise_left), Eigen::Vector3d::UnitX())).toRotationMatrix();
  return T_map_vehicle;
}

/// x forward, y left, z up out of x right, y down, z forward.
Eigen::Matrix3d lidar_from_camera() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R;
}

Eigen::Isometry3d pose_of_row(const std::vector<double>& row) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (row.size() == 12) {
    pose.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(row.data());
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  } else {
    pose.translation() << row[1], row[2], row[3];
    pose.linear() = Eigen::Quaterniond(row[7], row[4], row[5], row[6]).normalized().toRotationMatrix();
  }
  return pose;
}

/// Speed at each state of a car, `step_m` apart: limited in bends, nearly none where it changes gear, accelerating and braking gently.
std::vector<double> speeds(const std::vector<CarState>& states, double step_m, double limit_mps) {
  constexpr double lateral_mps2 = 2.5, along_mps2 = 1.5, turn_rate_radps = 0.6, crawl_mps = 0.3;
  std::vector<double> speed(states.size(), limit_mps);
  for (std::size_t i = 1; i + 1 < states.size(); ++i) {
    const double curvature = std::max(1e-6, std::abs(states[i + 1].yaw - states[i - 1].yaw) / (2 * step_m));
    speed[i] = std::max(crawl_mps, std::min({limit_mps, std::sqrt(lateral_mps2 / curvature), turn_rate_radps / curvature}));
    if (states[i].backward != states[i + 1].backward) speed[i] = crawl_mps;
  }
  const auto reachable = [&](double from) { return std::sqrt(from * from + 2 * along_mps2 * step_m); };
  for (std::size_t i = 1; i < speed.size(); ++i) speed[i] = std::min(speed[i], reachable(speed[i - 1]));
  for (std::size_t i = speed.size() - 1; i-- > 0;) speed[i] = std::min(speed[i], reachable(speed[i + 1]));
  return speed;
}

}  // namespace

Eigen::Isometry3d DrivePath::pose(double stamp_s) const {
  if (size() == 1) return poses.front();
  const auto next = std::upper_bound(stamps_s.begin(), stamps_s.end(), stamp_s);
  const auto i = std::clamp<std::ptrdiff_t>(next - stamps_s.begin() - 1, 0, static_cast<std::ptrdiff_t>(size()) - 2);
  const auto at = [&](std::ptrdiff_t k) -> const Eigen::Isometry3d& { return poses[static_cast<std::size_t>(k)]; };
  const auto stamp = [&](std::ptrdiff_t k) { return stamps_s[static_cast<std::size_t>(k)]; };
  const auto last = static_cast<std::ptrdiff_t>(size()) - 1;
  const double interval = stamp(i + 1) - stamp(i), u = (stamp_s - stamp(i)) / interval;
  const auto velocity = [&](std::ptrdiff_t k) {
    const auto before = std::max<std::ptrdiff_t>(k - 1, 0), after = std::min(k + 1, last);
    return Eigen::Vector3d((at(after).translation() - at(before).translation()) / (stamp(after) - stamp(before)) * interval);
  };
  const Eigen::Vector3d p0 = at(i).translation(), p1 = at(i + 1).translation(), v0 = velocity(i), v1 = velocity(i + 1);
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  if (u < 0) T_map_sensor.translation() = p0 + u * v0;
  else if (u > 1) T_map_sensor.translation() = p1 + (u - 1) * v1;
  else
    T_map_sensor.translation() = (2 * u * u * u - 3 * u * u + 1) * p0 + (u * u * u - 2 * u * u + u) * v0 +
                                 (3 * u * u - 2 * u * u * u) * p1 + (u * u * u - u * u) * v1;
  const Eigen::AngleAxisd turn(at(i).linear().transpose() * at(i + 1).linear());
  T_map_sensor.linear() = at(i).linear() * Eigen::AngleAxisd(u * turn.angle(), turn.axis()).toRotationMatrix();
  return T_map_sensor;
}

DrivePath ride(const std::vector<TrackPoint>& track, const Terrain& terrain, const PlatformOptions& platform, std::uint64_t seed) {
  const Wobble wobble(platform, seed);
  DrivePath path;
  for (const TrackPoint& point : track) {
    path.stamps_s.push_back(point.stamp_s);
    path.poses.push_back(vehicle_on_ground(point, terrain) *
                         Eigen::AngleAxisd(wobble.pitch(point.stamp_s), Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(wobble.roll(point.stamp_s), Eigen::Vector3d::UnitX()) *
                         Eigen::Translation3d(0, 0, platform.mount_height_m));
  }
  return path;
}

RecordedPoses read_recorded_poses(const std::filesystem::path& file, const std::string& axes) {
  std::ifstream input(file);
  if (!input) throw IoError(file, "cannot be read");
  RecordedPoses recorded;
  std::string line;
  for (std::size_t line_number = 1; std::getline(input, line); ++line_number) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::vector<double> row;
    for (double value; words >> value;) row.push_back(value);
    const bool finite = std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); });
    if (!words.eof() || (row.size() != 12 && row.size() != 8) || !finite)
      throw FormatError(file, "line " + std::to_string(line_number) + " is no pose: 12 numbers (KITTI) or 8 (TUM) expected");
    if (row.size() == 8) recorded.stamps_s.push_back(row[0]);
    recorded.poses.push_back(pose_of_row(row));
  }
  if (recorded.poses.empty()) throw FormatError(file, "holds no poses");
  if (!recorded.stamps_s.empty() && recorded.stamps_s.size() != recorded.poses.size())
    throw FormatError(file, "mixes rows of 12 and of 8 numbers");
  if (axes == "camera") {
    Eigen::Isometry3d T_lidar_camera = Eigen::Isometry3d::Identity();
    T_lidar_camera.linear() = lidar_from_camera();
    for (Eigen::Isometry3d& pose : recorded.poses) pose = T_lidar_camera * pose * T_lidar_camera.inverse();
  }
  return recorded;
}

std::vector<TrackPoint> drive_along(const std::vector<Eigen::Vector2d>& line, double lane_offset_m, const DriveSpeed& speed,
                                    std::size_t count) {
  constexpr double step_m = 0.25;
  const std::vector<CarState> states = steer_along(line, lane_offset_m, step_m);
  const std::vector<double> car_speeds = speeds(states, step_m, speed.speed_mps);

  std::vector<TrackPoint> track;
  double position = 0;   // index into the states
  const double period_s = 1 / speed.rate_hz;
  for (std::size_t k = 0; k < count; ++k) {
    if (position > static_cast<double>(states.size() - 2)) break;
    const auto i = static_cast<std::size_t>(position);
    const double u = position - static_cast<double>(i);
    track.push_back({static_cast<double>(k) * period_s, (1 - u) * states[i].position + u * states[i + 1].position,
                     (1 - u) * states[i].yaw + u * states[i + 1].yaw});
    position += car_speeds[i] * period_s / step_m;
  }
  return track;
}

}  // namespace priormap
