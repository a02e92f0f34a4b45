#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include <priormap/simulation/drive_path.hpp>
#include <priormap/simulation/town.hpp>

namespace priormap {

/// Cars that drive along the same line as the vehicle: some before and behind it at its speed, a stream of others towards it on its left.
class Traffic {
 public:
  /// @param track      the vehicle's
  /// @param spacing_m  mean distance between the cars of one direction; 0: no traffic
  Traffic(const std::vector<TrackPoint>& track, double spacing_m, std::uint64_t seed);

  /// Cars within 120 m of the vehicle at a point of its track, standing on the ground.
  std::vector<Car> at(std::size_t track_index, const Terrain& terrain) const;

 private:
  Car car(double station_m, double left_m, bool oncoming, std::int64_t number, const Terrain& terrain) const;
  std::vector<TrackPoint> track_;
  std::vector<double> stations_;   ///< metres driven at each point of the track
  double spacing_m_;
  std::uint64_t seed_;
};

}  // namespace priormap
