#pragma once
#include <span>

#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/prior/prior_writer.hpp>

#include "lattice.hpp"
#include "point_record.hpp"

namespace priormap {

/// Fills the columns of `records` but x, y and z with those of the points from `first` on.
void fill_columns(const PointCloud& points, std::size_t first, std::span<PointRecord> records);

/// Records as a cloud with all columns. Its origin is `corner`, z at a whole metre below the points.
PointCloud cloud_of(std::span<const PointRecord> records, LatticePoint corner);

}  // namespace priormap
