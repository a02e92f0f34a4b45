#include "scan_voxels.hpp"

#include <algorithm>
#include <array>

// Compiled for AVX2 as well, and the loader takes what the processor has. Without fused multiply-add: the results are the same. (ThreadSanitizer is not there yet when the
// loader asks.)
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)
#define PRIORMAP_ALSO_AVX2 __attribute__((target_clones("avx2", "default")))
#else
#define PRIORMAP_ALSO_AVX2
#endif

namespace priormap {
namespace {

constexpr std::size_t batch = 512;   // stays in the fastest cache

/// The voxels of coordinates along one axis, relative to `origin_m`.
PRIORMAP_ALSO_AVX2 void find_voxels(const float* relative_m, double origin_m, double voxel_m, std::size_t count, std::int32_t* voxels) {
  for (std::size_t i = 0; i < count; ++i) {
    const double in_voxels = (origin_m + static_cast<double>(relative_m[i])) / voxel_m;
    const auto truncated = static_cast<std::int32_t>(in_voxels);
    voxels[i] = truncated - (in_voxels < static_cast<double>(truncated));
  }
}

}  // namespace

ThinnedScan thinned_in_map(const PointCloud& scan, const Eigen::Isometry3d& T_map_sensor, double voxel_m, double range_m) {
  ThinnedScan thinned;
  thinned.points.origin = T_map_sensor.translation();
  const Eigen::Matrix3f R = T_map_sensor.linear().cast<float>();
  const auto range2 = static_cast<float>(range_m * range_m);
  const bool has_intensity = !scan.intensity.empty();
  VoxelOccupancy occupied;
  std::array<std::array<float, batch>, 3> p;
  std::array<std::array<std::int32_t, batch>, 3> voxels;
  Eigen::Vector3i last = Eigen::Vector3i::Zero();
  bool any = false;
  for (std::size_t first = 0; first < scan.size(); first += batch) {
    const std::size_t count = std::min(batch, scan.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f p_map = R * scan.xyz[first + i];
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis][i] = p_map[static_cast<Eigen::Index>(axis)];
    }
    for (std::size_t axis = 0; axis < 3; ++axis) find_voxels(p[axis].data(), thinned.points.origin[static_cast<Eigen::Index>(axis)], voxel_m, count, voxels[axis].data());
    for (std::size_t i = 0; i < count; ++i) {
      if (scan.xyz[first + i].squaredNorm() > range2) continue;
      const Eigen::Vector3i voxel(voxels[0][i], voxels[1][i], voxels[2][i]);
      if (any && voxel == last) continue;   // as neighbours on a ring near the sensor
      last = voxel;
      any = true;
      const VoxelOccupancy::Place place = occupied.insert(voxel);
      if (!place.was_free) continue;
      thinned.points.xyz.emplace_back(p[0][i], p[1][i], p[2][i]);
      if (has_intensity) thinned.points.intensity.push_back(scan.intensity[first + i]);
      thinned.bits.push_back(512 * place.block + place.bit);
    }
  }
  thinned.blocks = occupied.blocks();
  return thinned;
}

}  // namespace priormap
