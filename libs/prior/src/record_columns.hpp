#pragma once
#include <span>

#include <priormap/pointcloud/point_cloud.hpp>

#include "lattice.hpp"
#include "point_record.hpp"

namespace priormap {

/// Columns of a cloud as the columns of records, positions left out.
class RecordColumns {
 public:
  explicit RecordColumns(const PointCloud& points) : points_(points) {}
  PointRecord record(std::size_t i) const;

 private:
  const PointCloud& points_;
};

/// A place on the lattice that records count their x and y from.
struct LatticePoint {
  std::int64_t x = 0, y = 0;
};

/// Records as a cloud. Its origin is `corner`, z at a whole metre below the points.
PointCloud cloud_of(std::span<const PointRecord> records, LatticePoint corner);

}  // namespace priormap
