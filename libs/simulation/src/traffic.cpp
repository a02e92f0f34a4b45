#include <priormap/simulation/traffic.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <priormap/simulation/random.hpp>

#include "stream.hpp"

namespace priormap {
namespace {

constexpr double sight_m = 120;
constexpr double oncoming_mps = 8;
constexpr double oncoming_left_m = 2.4;
constexpr double jitter_share = 0.35;   // of the spacing: cars never overlap

}  // namespace

Traffic::Traffic(const std::vector<TrackPoint>& track, double spacing_m, std::uint64_t seed)
    : track_(track), stations_{0}, spacing_m_(spacing_m), seed_(seed) {
  for (std::size_t i = 1; i < track.size(); ++i) stations_.push_back(stations_.back() + (track[i].position - track[i - 1].position).norm());
}

std::vector<Car> Traffic::at(std::size_t track_index, const Terrain& terrain) const {
  std::vector<Car> cars;
  if (spacing_m_ <= 0) return cars;
  const double here_m = stations_[track_index];
  const auto add = [&](double station_m, bool oncoming, std::int64_t number) {
    if (std::abs(station_m - here_m) > sight_m || station_m < 0 || station_m > stations_.back()) return;
    cars.push_back(car(station_m, oncoming ? oncoming_left_m : 0, oncoming, number, terrain));
  };
  const auto jitter_m = [&](std::int64_t number, std::uint64_t direction) {
    return spacing_m_ * Random(seed_, {stream::moving_cars, static_cast<std::uint64_t>(number), direction}).uniform(-jitter_share, jitter_share);
  };
  const auto reach = static_cast<std::int64_t>(sight_m / spacing_m_) + 2;
  for (std::int64_t k = -reach; k <= reach; ++k)
    if (k != 0) add(here_m + static_cast<double>(k) * spacing_m_ + jitter_m(k, 0), false, k);
  // Car k of the stream starts at k times the spacing and comes nearer.
  const double drift_m = oncoming_mps * (track_[track_index].stamp_s - track_.front().stamp_s);
  const auto nearest = static_cast<std::int64_t>(std::floor((here_m + drift_m) / spacing_m_));
  for (std::int64_t k = nearest - reach; k <= nearest + reach; ++k) add(static_cast<double>(k) * spacing_m_ + jitter_m(k, 1) - drift_m, true, k);
  return cars;
}

Car Traffic::car(double station_m, double left_m, bool oncoming, std::int64_t number, const Terrain& terrain) const {
  const auto next = std::upper_bound(stations_.begin(), stations_.end(), station_m);
  const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(next - stations_.begin() - 1, 0, static_cast<std::ptrdiff_t>(track_.size()) - 2));
  const double run = stations_[i + 1] - stations_[i], u = run > 0 ? (station_m - stations_[i]) / run : 0;
  const double yaw = track_[i].yaw + u * std::remainder(track_[i + 1].yaw - track_[i].yaw, 2 * std::numbers::pi);
  const Eigen::Vector2d place = (1 - u) * track_[i].position + u * track_[i + 1].position + left_m * Eigen::Vector2d(-std::sin(yaw), std::cos(yaw));
  Random random(seed_, {stream::moving_cars, static_cast<std::uint64_t>(number), oncoming ? 3u : 2u});
  const Eigen::Vector3d size(random.uniform(3.8, 4.8), random.uniform(1.7, 1.85), random.uniform(1.42, 1.7));
  return {{place.x(), place.y(), terrain.height(place)}, oncoming ? yaw + std::numbers::pi : yaw, size};
}

}  // namespace priormap
