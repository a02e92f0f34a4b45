#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include <priormap/mapping/mapped_scan.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/scan_source.hpp>

#include "scan_record.hpp"
#include "mapping_method.hpp"
#include "odometry.hpp"

namespace priormap {

/// A part of a drive that an odometry of its own drives through: from `begin`, where it comes to know the street, over its own scans [first, last).
struct Stretch {
  std::size_t begin, first, last;
};

/// Cuts a drive into stretches of about equal length.
std::vector<Stretch> stretches_of(std::size_t first, std::size_t last, const StretchOptions& options);

struct DrivenScan {
  MappedScan mapped;   ///< but for its place in the map; step_s is what the odometry took
  OdometryStep step;   ///< in the frame of the stretch
};

struct DrivenStretch {
  std::vector<DrivenScan> shared, own;
  Odometry odometry;   ///< as it stands after the last scan
};

/// @param first_velocity  rad/s, m/s in sensor axes, at its first scan; none: it is looked for
DrivenStretch drive(const Stretch& stretch, const ScanSource& source, const JointMethodOptions& options, const std::optional<Vector6d>& first_velocity);

/// How the frame of a stretch lies in that of the stretches before it, from the last scans that both drove. None where they do not agree, as where either was lost: then the stretch
/// has to be driven from where the last one ended.
/// @param before  records of the scans so far, the shared ones last
std::optional<Eigen::Isometry3d> T_odom_stretch(std::span<const ScanRecord> before, std::span<const DrivenScan> shared);

}  // namespace priormap
