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

/// A tile's records as a cloud with its origin at the tile's lower-left corner, z origin at a whole metre below the points.
PointCloud cloud_of(std::span<const PointRecord> records, const LatticeGrid& grid, TileKey key);

}  // namespace priormap
