#include "trajectory_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include <priormap/core/output_file.hpp>

namespace priormap {
namespace {

namespace fs = std::filesystem;
using Isometry = Eigen::Isometry3d;

/// Decimals at which text loses nothing a reader could use: micrometres, nanoseconds of stamps, 1e-10 of quaternions.
std::string fixed(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

/// qx qy qz qw with qw >= 0.
Eigen::Vector4d quaternion_of(const Isometry& T) {
  const Eigen::Quaterniond q(T.linear());
  return q.w() < 0 ? Eigen::Vector4d(-q.coeffs()) : Eigen::Vector4d(q.coeffs());
}

std::string position_and_quaternion(const Isometry& T, char separator) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += fixed(T.translation()[i], 6) + separator;
  const Eigen::Vector4d q = quaternion_of(T);
  for (int i = 0; i < 4; ++i) text += fixed(q[i], 10) + (i < 3 ? std::string(1, separator) : "");
  return text;
}

void write_tum(const fs::path& file, const std::vector<MappedScan>& scans, Isometry MappedScan::*pose) {
  OutputFile out(file);
  for (const auto& scan : scans) out << fixed(scan.stamp_s, 9) << ' ' << position_and_quaternion(scan.*pose, ' ') << '\n';
  out.close();
}

void write_kitti(const fs::path& file, const std::vector<MappedScan>& scans) {
  OutputFile out(file);
  for (const auto& scan : scans) {
    const auto& M = scan.T_map_sensor.matrix();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) out << fixed(M(row, column), column < 3 ? 10 : 6) << (row == 2 && column == 3 ? '\n' : ' ');
  }
  out.close();
}

/// Standard deviations of position along the axes of `T`'s target frame [m] and about the sensor's axes [deg].
std::string sigmas(const Matrix6d& covariance, const Isometry& T) {
  const Eigen::Matrix3d position = T.linear() * covariance.bottomRightCorner<3, 3>() * T.linear().transpose();
  std::string text;
  for (int i = 0; i < 3; ++i) text += "," + fixed(std::sqrt(position(i, i)), 4);
  for (int i = 0; i < 3; ++i) text += "," + fixed(std::sqrt(covariance(i, i)) * 180 / std::numbers::pi, 4);
  return text;
}

void write_csv(const fs::path& file, const std::vector<MappedScan>& scans, const MapFrame& frame) {
  OutputFile out(file);
  out << "index,stamp_s,x_m,y_m,z_m,qx,qy,qz,qw,lon_deg,lat_deg,sigma_x_m,sigma_y_m,sigma_z_m,sigma_roll_deg,sigma_pitch_deg,sigma_yaw_deg,verdict,weak_direction\n";
  for (const auto& scan : scans) {
    const Isometry T = frame.georeferenced() ? frame.pose_to_projected(scan.T_map_sensor) : scan.T_map_sensor;
    std::string lon_lat = ",";
    if (frame.georeferenced()) {
      std::array<Eigen::Vector3d, 1> p = {scan.T_map_sensor.translation()};
      frame.to_lon_lat(p);
      lon_lat = fixed(p[0].x(), 9) + "," + fixed(p[0].y(), 9);
    }
    out << scan.index << ',' << fixed(scan.stamp_s, 9) << ',' << position_and_quaternion(T, ',') << ',' << lon_lat << sigmas(scan.covariance, T) << ','
        << to_string(scan.verdict) << ',' << direction_text(scan.weak_axis) << '\n';
  }
  out.close();
}

/// One line string a stretch of one verdict, neighbours sharing their end point, so that a GIS can colour by it.
void write_geojson(const fs::path& file, const std::vector<MappedScan>& scans, const MapFrame& frame) {
  std::vector<Eigen::Vector3d> lon_lat;
  for (const auto& scan : scans) lon_lat.push_back(scan.T_map_sensor.translation());
  frame.to_lon_lat(lon_lat);
  const auto position = [&](std::size_t i) { return "[" + fixed(lon_lat[i].x(), 9) + "," + fixed(lon_lat[i].y(), 9) + "," + fixed(lon_lat[i].z(), 3) + "]"; };

  OutputFile out(file);
  out << "{\"type\":\"FeatureCollection\",\"features\":[";
  for (std::size_t first = 0; first < scans.size();) {
    std::size_t last = first + 1;
    while (last < scans.size() && scans[last].verdict == scans[first].verdict) ++last;
    const std::size_t shared_end = std::min(last, scans.size() - 1);
    out << (first ? "," : "") << "\n{\"type\":\"Feature\",\"properties\":{\"verdict\":\"" << to_string(scans[first].verdict) << "\",\"first_index\":"
        << scans[first].index << ",\"last_index\":" << scans[last - 1].index << "},\"geometry\":";
    if (shared_end > first) {
      out << "{\"type\":\"LineString\",\"coordinates\":[";
      for (std::size_t i = first; i <= shared_end; ++i) out << (i > first ? "," : "") << position(i);
      out << "]}}";
    } else {
      out << "{\"type\":\"Point\",\"coordinates\":" << position(first) << "}}";
    }
    first = last;
  }
  out << "\n]}\n";
  out.close();
}

}  // namespace

void write_trajectories(const fs::path& directory, const std::vector<MappedScan>& scans, const MapFrame& frame) {
  write_csv(directory / "trajectory.csv", scans, frame);
  write_tum(directory / "poses_tum.txt", scans, &MappedScan::T_map_sensor);
  write_tum(directory / "poses_online_tum.txt", scans, &MappedScan::T_map_online);
  write_kitti(directory / "poses_kitti.txt", scans);
  if (frame.georeferenced()) write_geojson(directory / "trajectory.geojson", scans, frame);
}

}  // namespace priormap
