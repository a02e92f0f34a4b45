#pragma once
#include <cstdint>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/registration/surfel.hpp>
#include <vector>

namespace priormap {

/// Reduces scans to one surfel a voxel: one pass over the points with a flat hash, mean and second moments at once. Every point counts, so the mean of a voxel is far
/// better than one of its points. Surfels come in the order in which their voxels were first seen: the same points give the same bytes.
/// Points that are not finite or farther than 2^20 voxels from the origin are left out. Keeps its buffers from scan to scan: one reducer a thread.
class ScanReducer {
 public:
  /// @throws UsageError unless `voxel_m` > 0.
  explicit ScanReducer(double voxel_m);
  SurfelCloud reduce(const PointCloud& scan);

 private:
  struct alignas(64) Cell {
    std::uint64_t key;
    float count;
    float sum[3];      // relative to the voxel's centre
    float squares[6];  // xx xy xz yy yz zz
  };
  Cell& cell_of(std::uint64_t key);
  void grow();

  float voxel_m_;
  std::vector<Cell> cells_;            // in order of first sight
  std::vector<std::uint32_t> slots_;   // open addressing, index into cells_
};

/// Surfels merged by voxels of a coarser grid (means and covariances of all points behind them), in order of first sight.
SurfelCloud coarsen(const SurfelCloud& cloud, double voxel_m);

}  // namespace priormap
