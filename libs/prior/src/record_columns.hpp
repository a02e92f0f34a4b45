#pragma once
#include <span>

#include <priormap/pointcloud/point_cloud.hpp>

#include "lattice.hpp"
#include "point_record.hpp"

namespace priormap {

/// Fills the columns of `records` but x, y and z with those of the points from `first` on.
void fill_columns(const PointCloud& points, std::size_t first, std::span<PointRecord> records);

/// A place on the lattice that records count their x and y from.
struct LatticePoint {
  std::int64_t x = 0, y = 0;
};

/// Records as a cloud with all columns. Its origin is `corner`, z at a whole metre below the points.
PointCloud cloud_of(std::span<const PointRecord> records, LatticePoint corner);

}  // namespace priormap
