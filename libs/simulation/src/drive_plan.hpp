#pragma once
#include <priormap/geodesy/map_frame.hpp>
#include <priormap/simulation/drive.hpp>
#include <priormap/simulation/town_generator.hpp>

namespace priormap {

/// A drive before its town stands: frame `map` at the first pose, streets, ground, track.
struct DrivePlan {
  MapFrame frame;
  TownPlan town;
  std::vector<TrackPoint> track;
  std::vector<TrackPoint> elsewhere;   ///< where the vehicle is kidnapped to; empty: it is not
  std::optional<std::vector<Building>> buildings;   ///< of an OSM town: as the file has them, not yet on the ground; none: a town is to be generated
};

/// @throws UsageError, CrsError, IoError, FormatError
DrivePlan plan_drive(const DriveOptions& options, int threads);

std::vector<Eigen::Vector2d> line_of(const std::vector<TrackPoint>& track);

double scan_rate_hz(const DriveOptions& options);

}  // namespace priormap
