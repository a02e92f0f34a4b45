#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// A grid of points in the target CRS, row by row, with one more on each side than are asked for: the neighbours of the outermost.
/// Where there is no height, z is NaN and x, y mean nothing.
struct PointGrid {
  std::size_t width = 0, height = 0;   ///< with the neighbours
  std::vector<double> x, y, z;
  /// The way from one point to the next one in its row, and to the one below: equal all over a grid of a few km, for normals.
  Eigen::Vector2d along = Eigen::Vector2d::Zero(), down = Eigen::Vector2d::Zero();

  std::array<std::vector<float>, 6> work;   ///< of `points_of_grid`, kept from grid to grid

  void resize(std::size_t new_width, std::size_t new_height);
  std::size_t size() const { return width * height; }
};

/// Replaces `points` by the inner points inside of `area`, with their normals, column by column from the west and the south of a north-up
/// grid: the order in which tiles are sorted. Positions are rounded to 0.001 first.
void points_of_grid(PointGrid& grid, const Bounds2& area, PointCloud& points);

/// Walls at the steps of a grid: where the heights of two neighbours differ by more than `least_step`, a raster knows no more than that a surface rises somewhere between
/// their centres.
struct StepWalls {
  double least_step;   ///< in the unit of z
  double rise;         ///< from one point of a wall to the next above, in the unit of z
};

/// Replaces `points` by those of the walls inside of `area`: in the middle between two neighbours, with the normal from the higher to the lower. Each pair of neighbours counts
/// in the grid that holds its first, in the row or column, as an inner point.
void walls_of_grid(const PointGrid& grid, const StepWalls& walls, const Bounds2& area, PointCloud& points);

}  // namespace priormap
