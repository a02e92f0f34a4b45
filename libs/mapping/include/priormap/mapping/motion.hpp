#pragma once
#include <Eigen/Geometry>
#include <cstddef>

#include <priormap/mapping/scan_source.hpp>

namespace priormap {

/// The pose after `last` if the motion from `before_last` goes on unchanged (the paper, section III-E): t + (t - t'), q' (q'^-1 q)^2, which is
/// slerp(q', q, 2). Needs no stamps.
Eigen::Isometry3d predict(const Eigen::Isometry3d& T_map_before_last, const Eigen::Isometry3d& T_map_last);

/// T_previous_sensor when a recording of scans [first, last) begins, found without a guess: one that begins at speed, met with a motion of zero, loses its first steps,
/// for the traces of the lasers on the ground fit best where nothing has moved (docs/adr/0022). Up to 4 m a scan; reads the first three. Identity for a recording of one scan, and where nothing tells of a motion.
/// @throws what reading throws
Eigen::Isometry3d motion_at_start(const ScanSource& source, std::size_t first, std::size_t last);

/// Seconds from the first scan to the second; 0.1 where the stamps do not say.
double period_at_start(const ScanSource& source, std::size_t first, std::size_t last);

}  // namespace priormap
