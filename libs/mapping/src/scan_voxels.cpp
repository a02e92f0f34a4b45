#include "scan_voxels.hpp"

#include <algorithm>
#include <array>

#include <priormap/core/also_avx2.hpp>

namespace priormap {
namespace {

/// The voxels of coordinates along one axis, relative to `origin_m`.
PRIORMAP_ALSO_AVX2 void find_voxels(const float* relative_m, double origin_m, double voxel_m, std::size_t count, std::int32_t* voxels) {
  for (std::size_t i = 0; i < count; ++i) {
    const double in_voxels = (origin_m + static_cast<double>(relative_m[i])) / voxel_m;
    const auto truncated = static_cast<std::int32_t>(in_voxels);
    voxels[i] = truncated - (in_voxels < static_cast<double>(truncated));
  }
}

/// Some points of a scan, in the axes of `map`, and how far they are from the sensor.
struct Batch {
  static constexpr std::size_t size = 512;   // stays in the fastest cache
  std::array<float, size> x, y, z, range2;
};

/// @param R  row by row. Sums in the order in which Eigen has them.
PRIORMAP_ALSO_AVX2 void turn(const float* xyz, const float* R, std::size_t count, Batch& turned) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = xyz[3 * i], y = xyz[3 * i + 1], z = xyz[3 * i + 2];
    turned.x[i] = R[0] * x + (R[1] * y + R[2] * z);
    turned.y[i] = R[3] * x + (R[4] * y + R[5] * z);
    turned.z[i] = R[6] * x + (R[7] * y + R[8] * z);
    turned.range2[i] = x * x + (y * y + z * z);
  }
}

}  // namespace

ThinnedScan thinned_in_map(const PointCloud& scan, const Eigen::Isometry3d& T_map_sensor, double voxel_m, double range_m) {
  ThinnedScan thinned;
  thinned.points.origin = T_map_sensor.translation();
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R = T_map_sensor.linear().cast<float>();
  const auto range2 = static_cast<float>(range_m * range_m);
  const bool has_intensity = !scan.intensity.empty();
  VoxelOccupancy occupied;
  const Eigen::Vector3d& origin = thinned.points.origin;
  Batch p;
  std::array<std::int32_t, Batch::size> voxel_x, voxel_y, voxel_z;
  Eigen::Vector3i last = Eigen::Vector3i::Zero();
  bool any = false;
  for (std::size_t first = 0; first < scan.size(); first += Batch::size) {
    const std::size_t count = std::min(Batch::size, scan.size() - first);
    turn(scan.xyz[first].data(), R.data(), count, p);
    find_voxels(p.x.data(), origin.x(), voxel_m, count, voxel_x.data());
    find_voxels(p.y.data(), origin.y(), voxel_m, count, voxel_y.data());
    find_voxels(p.z.data(), origin.z(), voxel_m, count, voxel_z.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (p.range2[i] > range2) continue;
      const Eigen::Vector3i voxel(voxel_x[i], voxel_y[i], voxel_z[i]);
      if (any && voxel == last) continue;   // as neighbours on a ring near the sensor
      last = voxel;
      any = true;
      const VoxelOccupancy::Place place = occupied.insert(voxel);
      if (!place.was_free) continue;
      thinned.points.xyz.emplace_back(p.x[i], p.y[i], p.z[i]);
      if (has_intensity) thinned.points.intensity.push_back(scan.intensity[first + i]);
      thinned.bits.push_back(512 * place.block + place.bit);
    }
  }
  thinned.blocks = occupied.blocks();
  return thinned;
}

}  // namespace priormap
