#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <string>

#include <priormap/evaluation/trajectory.hpp>

namespace priormap {

/// tum: `t x y z qx qy qz qw`; kitti: the 12 numbers of a 3x4 matrix in row order, optionally after the scan's index;
/// csv: columns found by their names (see read_trajectory).
enum class TrajectoryFormat { automatic, tum, kitti, csv };

/// @throws UsageError for another word than auto, tum, kitti, csv.
TrajectoryFormat trajectory_format(const std::string& word);

/// Reads a trajectory; lines that start with # and empty lines are skipped.
///
/// A csv has a header. Its poses are the first of these column sets that applies:
///   east_m,north_m,height_m,grid_qx,grid_qy,grid_qz,grid_qw    in a projected CRS, when that CRS is known
///   x_m,y_m,z_m,qx,qy,qz,qw                                    in a projected CRS when one is known (and the set above is absent), else metric
///   lat_deg,lon_deg,alt_m,roll_rad,pitch_rad,yaw_rad           WGS 84, yaw counter-clockwise from true east (KITTI's OXTS); becomes UTM
/// and `index` or `frame`, `stamp_s` or `unix_time_s` beside them. The CRS is the field "crs" of run.json's "frame" or of frame.json in the csv's
/// folder, else `default_crs` (may be empty).
/// @throws IoError when the file cannot be read; FormatError naming the line that is no pose, or a file without poses;
/// CrsError when the columns are projected coordinates (they come with lon_deg, lat_deg) and no CRS is known.
Trajectory read_trajectory(const std::filesystem::path& file, TrajectoryFormat format, const std::string& default_crs);

/// T_cam0_velodyne from the line `Tr:` of a KITTI calib.txt. @throws IoError, FormatError
Eigen::Isometry3d read_kitti_calibration(const std::filesystem::path& file);

/// KITTI's ground truth, poses of camera 0 in the first camera frame (y down), as poses of the velodyne in its first frame (z up).
void camera_to_velodyne(Trajectory& trajectory, const Eigen::Isometry3d& T_cam0_velodyne);

}  // namespace priormap
