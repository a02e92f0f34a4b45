#include <priormap/mapping/map_writer.hpp>

#include <array>
#include <utility>

#include <priormap/core/parallel.hpp>
#include <priormap/core/process.hpp>
#include <priormap/prior/prior_writer.hpp>

#include "scan_voxels.hpp"
#include "sweep_motion.hpp"

namespace priormap {
namespace {

constexpr std::size_t occupancy_limit_bytes = 96u << 20, spool_bytes = 64u << 20;

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

ThinnedScan thinned_in_map(Scan scan, const MappedScan& mapped, const MapOptions& options) {
  if (mapped.motion_undone) undo_motion(scan.points, mapped.velocity);
  return thinned_in_map(scan.points, mapped.T_map_sensor, options.voxel_m, options.range_m);
}

/// Those of its points that fall into voxels not seen before, in the prior's CRS.
PointCloud new_points(const ThinnedScan& thinned, const LocalProjection& projection, VoxelOccupancy& occupied) {
  std::vector<std::array<std::uint64_t, 8>> free;
  free.reserve(thinned.blocks.size());
  for (const VoxelBlock& block : thinned.blocks) free.push_back(occupied.insert(block));
  PointCloud points;
  points.origin = projection.projected_center();
  for (std::size_t i = 0; i < thinned.points.size(); ++i) {
    const std::uint32_t bit = thinned.bits[i];
    if (!(free[bit >> 9][bit >> 6 & 7] >> (bit & 63) & 1)) continue;
    points.xyz.push_back(projection.from_center(thinned.points.position(i)).cast<float>());
    if (!thinned.points.intensity.empty()) points.intensity.push_back(thinned.points.intensity[i]);
  }
  points.classification.assign(points.size(), static_cast<std::uint8_t>(PointClass::unclassified));
  return points;
}

}  // namespace

PriorManifest write_map(const std::filesystem::path& directory, const ScanSource& source, const std::vector<MappedScan>& scans, const MapFrame& frame,
                        PriorManifest manifest, const MapOptions& options, int threads, const Events& events) {
  manifest.spacing_m = options.voxel_m;
  PriorWriter writer(directory, std::move(manifest), Overwrite::refuse, spool_bytes);
  VoxelOccupancy occupied;
  const std::size_t window = 2 * static_cast<std::size_t>(threads);
  std::vector<ThinnedScan> waiting(scans.size());
  ordered_pipeline(
      scans.size(), threads, window,
      [&](std::size_t i) { waiting[i] = thinned_in_map(source.read(scans[i].index), scans[i], options); },
      [&](std::size_t i) {
        const ThinnedScan thinned = std::exchange(waiting[i], {});
        const Eigen::Vector3d center = scans[i].T_map_sensor.translation();
        writer.add(new_points(thinned, LocalProjection(frame, center), occupied));
        if (occupied.memory_bytes() > occupancy_limit_bytes) occupied.forget_beyond(center, 2 * options.range_m, options.voxel_m);
        events.advance("writing the map", static_cast<double>(i + 1) / static_cast<double>(scans.size()));
      });
  occupied = VoxelOccupancy();   // writing the tiles needs the room
  return_freed_memory();
  return writer.finish(threads, events);
}

}  // namespace priormap
