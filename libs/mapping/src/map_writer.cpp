#include <priormap/mapping/map_writer.hpp>

#include <utility>

#include <priormap/core/parallel.hpp>
#include <priormap/prior/prior_writer.hpp>

#include "sweep_motion.hpp"
#include "voxel_occupancy.hpp"

namespace priormap {
namespace {

constexpr std::size_t occupancy_limit_bytes = 96u << 20;

/// `map` to the prior's CRS around one place. Both are conformal projections: over a scan's range the second order is below a tenth of a millimetre.
class LocalProjection {
 public:
  LocalProjection(const MapFrame& frame, const Eigen::Vector3d& center_map) : center_(center_map) {
    if (!frame.georeferenced()) {
      projected_center_ = center_map;
      return;
    }
    projected_center_ = frame.to_projected(center_map);
    constexpr double step_m = 50;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector3d step = step_m * Eigen::Vector3d::Unit(axis);
      linear_.col(axis) = (frame.to_projected(center_map + step) - frame.to_projected(center_map - step)) / (2 * step_m);
    }
  }
  const Eigen::Vector3d& projected_center() const { return projected_center_; }
  Eigen::Vector3d from_center(const Eigen::Vector3d& p_map) const { return linear_ * (p_map - center_); }

 private:
  Eigen::Vector3d center_, projected_center_;
  Eigen::Matrix3d linear_ = Eigen::Matrix3d::Identity();
};

/// The points of a scan that may go into the map, in `map` relative to the sensor: one a voxel.
PointCloud thinned_in_map(Scan scan, const MappedScan& mapped, const MapOptions& options) {
  PointCloud points;
  points.origin = mapped.T_map_sensor.translation();
  const Eigen::Matrix3f R = mapped.T_map_sensor.linear().cast<float>();
  if (mapped.motion_undone) undo_motion(scan.points, mapped.velocity);
  const auto range2 = static_cast<float>(options.range_m * options.range_m);
  VoxelOccupancy occupied(options.voxel_m);
  const bool has_intensity = !scan.points.intensity.empty();
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (scan.points.xyz[i].squaredNorm() > range2) continue;
    const Eigen::Vector3f p = R * scan.points.xyz[i];
    if (!occupied.insert(points.origin + p.cast<double>())) continue;
    points.xyz.push_back(p);
    if (has_intensity) points.intensity.push_back(scan.points.intensity[i]);
  }
  return points;
}

/// Those of them that fall into voxels not seen before, in the prior's CRS.
PointCloud new_points(const PointCloud& thinned, const LocalProjection& projection, VoxelOccupancy& occupied) {
  PointCloud points;
  points.origin = projection.projected_center();
  for (std::size_t i = 0; i < thinned.size(); ++i) {
    const Eigen::Vector3d p_map = thinned.position(i);
    if (!occupied.insert(p_map)) continue;
    points.xyz.push_back(projection.from_center(p_map).cast<float>());
    if (!thinned.intensity.empty()) points.intensity.push_back(thinned.intensity[i]);
  }
  points.classification.assign(points.size(), static_cast<std::uint8_t>(PointClass::unclassified));
  return points;
}

}  // namespace

PriorManifest write_map(const std::filesystem::path& directory, const ScanSource& source, const std::vector<MappedScan>& scans, const MapFrame& frame,
                        PriorManifest manifest, const MapOptions& options, int threads, const Events& events) {
  manifest.spacing_m = options.voxel_m;
  PriorWriter writer(directory, std::move(manifest), Overwrite::refuse);
  VoxelOccupancy occupied(options.voxel_m);
  const std::size_t window = 2 * static_cast<std::size_t>(threads);
  std::vector<PointCloud> waiting(scans.size());
  ordered_pipeline(
      scans.size(), threads, window,
      [&](std::size_t i) { waiting[i] = thinned_in_map(source.read(scans[i].index), scans[i], options); },
      [&](std::size_t i) {
        const PointCloud thinned = std::exchange(waiting[i], {});
        const Eigen::Vector3d center = scans[i].T_map_sensor.translation();
        writer.add(new_points(thinned, LocalProjection(frame, center), occupied));
        if (occupied.memory_bytes() > occupancy_limit_bytes) occupied.forget_beyond(center, 2 * options.range_m);
        events.advance("writing the map", static_cast<double>(i + 1) / static_cast<double>(scans.size()));
      });
  return writer.finish(threads, events);
}

}  // namespace priormap
