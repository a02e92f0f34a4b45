#include "steering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace priormap {
namespace {

constexpr double pi = std::numbers::pi;

Eigen::Vector2d direction(double yaw) { return {std::cos(yaw), std::sin(yaw)}; }

double direction_of(const Eigen::Vector2d& run) { return std::atan2(run.y(), run.x()); }

/// Yaw along a line, without jumps of a full turn.
std::vector<double> headings(const Polyline& line) {
  std::vector<double> yaws(line.size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d run = line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0];
    const double yaw = run.norm() > 1e-9 ? direction_of(run) : (i > 0 ? yaws[i - 1] : 0);
    yaws[i] = i == 0 ? yaw : yaws[i - 1] + std::remainder(yaw - yaws[i - 1], 2 * pi);
  }
  return yaws;
}

template <class T>
std::vector<T> moving_mean(const std::vector<T>& values, std::size_t half_width) {
  std::vector<T> means(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    // The window shrinks at the ends, evenly on both sides, so that the ends stay in place.
    const std::size_t reach = std::min({half_width, i, values.size() - 1 - i});
    T sum = values[i - reach];
    for (std::size_t k = i - reach + 1; k <= i + reach; ++k) sum += values[k];
    means[i] = sum / static_cast<double>(2 * reach + 1);
  }
  return means;
}

/// The line's right-hand lane, corners rounded.
Polyline lane_of(const Polyline& points, double lane_offset_m) {
  constexpr std::size_t rounding_steps = 20, yaw_steps = 6;   // at a step of 0.25 m: windows of 10 m and of 3 m
  const Polyline centre = moving_mean(moving_mean(points, rounding_steps), rounding_steps);
  const std::vector<double> yaws = moving_mean(headings(centre), yaw_steps);
  Polyline lane;
  for (std::size_t i = 0; i < centre.size(); ++i) lane.push_back(centre[i] - lane_offset_m * direction(yaws[i] + pi / 2));
  return lane;
}

/// Indices at which a line, sampled every `step_m`, turns back: more sharply than a car gets round.
std::vector<std::size_t> turning_points(const Polyline& points, double step_m) {
  constexpr double sharp_rad = 2 * pi / 3;
  const auto reach = static_cast<std::size_t>(turning_radius_m / step_m);
  const auto turns_at = [&](std::size_t i) {
    const double before = direction_of(points[i] - points[i - reach]), after = direction_of(points[i + reach] - points[i]);
    return std::abs(std::remainder(after - before, 2 * pi)) > sharp_rad;
  };
  std::vector<std::size_t> turns;
  for (std::size_t i = reach; i + reach < points.size(); ++i) {
    if (!turns_at(i)) continue;
    const std::size_t first = i;
    while (i + 1 + reach < points.size() && turns_at(i + 1)) ++i;
    turns.push_back((first + i) / 2);   // the corner itself: it shows as far before as behind
  }
  return turns;
}

class Car {
 public:
  Car(const CarState& start, double step_m) : states_{start}, step_m_(step_m) {}

  /// Steers for the point a little ahead on the lane (pure pursuit: Coulter, CMU-RI-TR-92-01), to the lane's end.
  void follow(const Polyline& lane) {
    constexpr double look_ahead_m = 4, slowest = 0.2;   // the point runs on at this share of the car's pace at least: a car never circles around it
    const Run run(lane);
    for (double s = 0; s < run.length(); s += slowest * step_m_) {
      const auto distance = [&](double at) { return (run.point(at) - states_.back().position).norm(); };
      while (s + step_m_ < run.length() && distance(s + step_m_) < distance(s)) s += step_m_;
      const double beyond_m = std::max(0.0, s + look_ahead_m - run.length());
      const Eigen::Vector2d ahead = run.point(s + look_ahead_m) + beyond_m * run.direction(run.length()) - states_.back().position;
      const double off = std::remainder(direction_of(ahead) - states_.back().yaw, 2 * pi);
      const double curvature = 2 * std::sin(std::clamp(off, -pi / 2, pi / 2)) / ahead.norm();
      roll(step_m_, std::clamp(curvature, -1 / turning_radius_m, 1 / turning_radius_m));
    }
  }

  /// Forward, back and forward again, each with the wheels fully turned, onto a lane `aside_m` farther to the left when it turns by half a turn.
  void turn_in_three_strokes(double by_rad, double aside_m) {
    const double forward_rad = std::acos(std::max(0.0, 0.5 * (1 - 0.5 * aside_m / turning_radius_m))) * by_rad / pi;
    stroke(forward_rad, 1);
    stroke(by_rad - 2 * forward_rad, -1);
    stroke(forward_rad, 1);
  }

  /// How far ahead a turn by half a turn reaches.
  static double room_m() { return turning_radius_m; }

  const std::vector<CarState>& states() const { return states_; }

 private:
  void stroke(double turn_rad, int gear) {
    const double length_m = std::abs(turn_rad) * turning_radius_m;
    const int steps = std::max(1, static_cast<int>(std::ceil(length_m / step_m_)));
    for (int i = 0; i < steps; ++i) roll(gear * length_m / steps, std::copysign(1 / turning_radius_m, gear * turn_rad));
  }
  void roll(double way_m, double curvature) {
    const CarState& last = states_.back();
    const double turn = way_m * curvature;
    states_.push_back({last.position + way_m * direction(last.yaw + 0.5 * turn), last.yaw + turn, way_m < 0});
  }
  std::vector<CarState> states_;
  double step_m_;
};

}  // namespace

std::vector<CarState> steer_along(const Polyline& line, double lane_offset_m, double step_m) {
  const Polyline points = resampled(line, step_m);
  std::vector<std::size_t> ends = turning_points(points, step_m);
  ends.push_back(points.size() - 1);
  const auto room = static_cast<std::ptrdiff_t>(Car::room_m() / step_m);
  std::optional<Car> car;
  for (std::size_t leg = 0, begin = 0; leg < ends.size(); begin = ends[leg++]) {
    const Polyline whole(points.begin() + static_cast<std::ptrdiff_t>(begin), points.begin() + static_cast<std::ptrdiff_t>(ends[leg]) + 1);
    const Polyline lane = lane_of(whole, lane_offset_m);
    const std::ptrdiff_t first = car ? room : 0, last = static_cast<std::ptrdiff_t>(lane.size()) - (leg + 1 < ends.size() ? room : 0);
    const double heading = direction_of(whole[std::min<std::size_t>(whole.size() - 1, 1)] - whole[0]);
    if (!car) {
      car.emplace(CarState{lane.front(), heading, false}, step_m);
    } else {
      constexpr double half_turn_rad = 5 * pi / 6;   // from here on to the left, as traffic keeps right
      double turn_rad = std::remainder(heading - car->states().back().yaw, 2 * pi);
      if (turn_rad < -half_turn_rad) turn_rad += 2 * pi;
      car->turn_in_three_strokes(turn_rad, 2 * lane_offset_m);
    }
    if (last - first > 1) car->follow(Polyline(lane.begin() + first, lane.begin() + last));
  }
  return car->states();
}

}  // namespace priormap
