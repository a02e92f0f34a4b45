#pragma once
#include <cstdint>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/registration/surfel.hpp>
#include <vector>

namespace priormap {

/// Reduces scans to one surfel a voxel: one pass over the points with a flat hash, mean and second moments at once. Every point counts, so the mean of a voxel is far
/// better than one of its points; and so its time, where the points have one. Surfels come in the order in which their voxels were first seen: the same points give the same bytes.
/// Points that are not finite or farther than 2^20 voxels from the origin are left out. Keeps its buffers from scan to scan: one reducer a thread.
class ScanReducer {
 public:
  /// @throws UsageError unless `voxel_m` > 0.
  explicit ScanReducer(double voxel_m);
  /// @param scan  in the frame of its sensor: what lies on the traces of single lasers is told by the cones that these draw about its z axis
  SurfelCloud reduce(const PointCloud& scan);

 private:
  /// Of a voxel, one cache line: sums of its points, relative to its centre.
  struct alignas(64) Cell {
    float sums[12];  // x, y, z, count, xx, xy, xz, yy, yz, zz, time, unused
    std::uint64_t key;
  };
  Cell& cell_of(std::uint64_t key);
  std::size_t slot_of(std::uint64_t key) const;
  void grow();
  void tell_from_around(SurfelCloud& scan) const;
  Surfel merged_around(std::size_t i, const SurfelCloud& scan) const;
  template <bool timed>
  void add(const float* xyz, const float* time_s, std::size_t count);

  float voxel_m_;
  std::vector<Cell> cells_;           // in order of first sight
  std::vector<std::uint32_t> slots_;  // numbers of cells, open addressing
};

}  // namespace priormap
