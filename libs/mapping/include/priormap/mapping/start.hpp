#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include <priormap/core/events.hpp>
#include <priormap/geodesy/map_frame.hpp>
#include <priormap/mapping/prior_points.hpp>

namespace priormap {

/// Where the first scan was taken, as the user says it.
struct InitialPose {
  std::vector<double> pose;                ///< x,y,z,qx,qy,qz,qw in the prior's CRS (grid axes) or its local frame; empty: not given
  std::vector<double> lon_lat_deg;         ///< longitude, latitude; empty: not given
  std::optional<double> height_m;          ///< in the prior's heights; none: the sensor stands on the prior's ground
  std::optional<double> yaw_deg;           ///< counter-clockwise from true east
  std::optional<double> heading_deg;       ///< clockwise from true north

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("initial-pose", pose, {"x,y,z,qx,qy,qz,qw of the first scan in the prior's CRS (quaternion against its grid axes), or in its local frame; heights of the drive are no surer than this one and the prior agree"});
    visit("initial-lonlat", lon_lat_deg, {"longitude,latitude of the first scan", "deg"});
    visit("initial-height", height_m, {"height of the sensor at the first scan, in the prior's heights; heights of the drive are no surer than this one and the prior agree; not given: on the prior's ground", "m", -1000, 10000});
    visit("initial-yaw", yaw_deg, {"direction of travel at the first scan, counter-clockwise from true east", "deg", -360, 360});
    visit("initial-heading", heading_deg, {"direction of travel at the first scan, clockwise from true north", "deg", -360, 360});
  }
};

/// The frame of the run and the first pose in it.
struct Start {
  MapFrame frame;
  std::optional<Crs> crs;                  ///< in which results are written; none: a local frame
  Eigen::Isometry3d T_map_sensor;
  bool knows_height = false;               ///< the user gave it
};

/// @param prior  null: odometry, in a local frame, or (with a longitude and latitude) in the UTM zone there
/// @param first_scan  tells how high above the ground the sensor is
/// @throws UsageError when the pose is missing, contradictory or malformed; CrsError; Error when the prior lies elsewhere (says how far)
Start find_start(const InitialPose& initial, const PriorPoints* prior, const PointCloud& first_scan, double prior_radius_m);

/// Warns of a start far above or below the prior's ground there: heights that count from different surfaces.
void warn_of_height(const Start& start, const PriorPoints& prior, const Events& events);

}  // namespace priormap
