#pragma once
#include <Eigen/Geometry>

#include <priormap/core/se3.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/registration/surfel.hpp>

namespace priormap {

/// The steady motion [rad/s, m/s] in sensor axes that leads from one pose to the other: T_to = T_from exp(duration velocity), with the exponential of SE(3)
/// (Sola et al., A micro Lie theory, 2018, eq. 172 and 174).
Vector6d steady_velocity(const Eigen::Isometry3d& T_from, const Eigen::Isometry3d& T_to, double duration_s);

/// Where the sensor is after a time at that velocity, from where it was.
Eigen::Isometry3d moved_on(const Eigen::Isometry3d& T, const Vector6d& velocity, double duration_s);

/// The sensor moves while it sweeps: a point seen `time_s` after the stamp was seen from elsewhere. These bring all points to where they would have been seen from at the stamp.
/// What carries no times (zeros, or no column) stays as it is. The origin of the scan is zero, as that of every Scan.
void undo_motion(PointCloud& scan, const Vector6d& velocity);
/// By the mean time of each surfel: exact in its mean to first order, also where a surfel holds points of several times.
void undo_motion(SurfelCloud& scan, const Vector6d& velocity);

/// Of the surfels [s, from the stamp]; 0 where there are none.
double mean_time_s(const SurfelCloud& scan);
void count_times_from(SurfelCloud& scan, double time_s);
/// To the frame that the scan's lies in.
void move(SurfelCloud& scan, const Eigen::Isometry3d& T_target_scan);

/// The time of the surfel farthest from the stamp.
double longest_time_s(const SurfelCloud& scan);

}  // namespace priormap
