#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include <priormap/core/option_field.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/simulation/drive_path.hpp>
#include <priormap/simulation/world.hpp>

namespace priormap {

/// One rotating or sweeping head: every azimuth step fires one ray per elevation.
struct LidarHead {
  Eigen::Isometry3d T_sensor_head = Eigen::Isometry3d::Identity();
  std::vector<double> elevations;      ///< above the head's horizon [rad]
  double first_azimuth, azimuth_span;  ///< counter-clockwise from forward; a negative span turns clockwise [rad]
  int azimuth_steps;
  double max_range_m;                  ///< for a target of 80 % reflectivity, met squarely
};

/// A sensor is one head, a rig several; all points come in the frame `sensor`: x forward, y left, z up.
struct LidarModel {
  std::string name;
  double rate_hz;
  std::vector<LidarHead> heads;
  std::size_t rays_per_scan() const;
};

/// "hdl64": Velodyne HDL-64E (32 lasers from +2 deg every 1/3 deg, 32 more from -8.83 deg every 1/2 deg; 0.18 deg in azimuth);
/// "hdl32": HDL-32E (-30.67 to 10.67 deg, 0.16 deg); "vlp16": VLP-16 (-15 to 15 deg, 0.2 deg); "os1-128": Ouster OS1-128 (45 deg in 128 beams, 1024 columns);
/// "rig4": two OS1-128 on the roof's sides and two forward- and backward-looking long-range sensors.
/// @throws UsageError naming the known ones.
LidarModel lidar_model(const std::string& name);
const std::vector<std::string>& lidar_names();

/// What makes a range differ from the truth.
struct LidarNoise {
  double range_sigma_m = 0.015;
  double laser_bias_sigma_m = 0.008;
  double dropout_share = 0.01;
  double glass_dropout_share = 0.6;
  double glass_through_share = 0.2;
  bool motion_distortion = false;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("range-sigma", range_sigma_m, {"noise of each range, standard deviation", "m", 0, 1});
    visit("laser-bias-sigma", laser_bias_sigma_m, {"constant range error of each laser, standard deviation", "m", 0, 1});
    visit("dropout-share", dropout_share, {"share of the returns lost for no reason", "", 0, 1});
    visit("glass-dropout-share", glass_dropout_share, {"share of the rays on glass that do not come back", "", 0, 1});
    visit("glass-through-share", glass_through_share, {"share of the rays on glass that come back from behind it", "", 0, 1});
    visit("motion-distortion", motion_distortion, {"each column is taken where the sensor is at its time; times go to point_times/"});
  }
};

/// Takes scans of a world. Immutable: scans may be taken from several threads.
class Lidar {
 public:
  Lidar(const World& world, LidarModel model, const LidarNoise& noise, std::uint64_t seed);

  /// Scan number `index` of the path: points in the frame `sensor` at the scan's stamp (the middle of the sweep), intensity 0 to 1;
  /// with motion distortion as the moving sensor saw them, with `time_s` from the stamp.
  /// @param others  cars in traffic at that time, beside the world's own; nullptr: none
  PointCloud scan(const DrivePath& path, std::size_t index, const std::vector<Car>* others = nullptr) const;

  const LidarModel& model() const { return model_; }

 private:
  struct HeadRays {
    std::vector<Eigen::Vector3f> directions;   ///< in `sensor`, one elevation after the other
    std::vector<float> biases_m;               ///< one an elevation
  };
  const World& world_;
  LidarModel model_;
  LidarNoise noise_;
  std::uint64_t seed_;
  std::vector<HeadRays> rays_;
};

}  // namespace priormap
