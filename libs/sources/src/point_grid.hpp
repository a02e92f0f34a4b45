#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/pointcloud/las.hpp>

namespace priormap {

/// A grid of places in the target CRS, line by line: of a north-up grid the lines from the west, their places from the south, as tiles are sorted. With a
/// margin more on each side than are asked for: the neighbours of the outermost. Where there is no height, z is NaN and x, y mean nothing.
struct PointGrid {
  static constexpr std::size_t margin = 2;
  std::size_t lines = 0, length = 0;   ///< with the neighbours
  std::vector<double> x, y, z;
  /// The way to the same place of the next line, and to the place before in its own: equal all over a grid of a few km, for normals.
  Eigen::Vector2d across = Eigen::Vector2d::Zero(), back = Eigen::Vector2d::Zero();

  void resize(std::size_t new_lines, std::size_t new_length);
  std::size_t size() const { return lines * length; }
};

/// Walls at the steps of a grid: where the heights of two neighbours differ by more than `least_step` and not by more than any wall is high, a raster knows no more than that a surface rises somewhere between
/// their centres.
struct StepWalls {
  double least_step, greatest_step;   ///< in the unit of z
  double rise;         ///< from one point of a wall to the next above, in the unit of z
};

/// Calls visit(points), some hundreds at a time, with the inner places inside of `area` with their normals, and with the points of walls inside of it: in the middle between two
/// neighbours, with the normal from the higher side to the lower one: that of the edge of what is high within two cells, for a wall across the grid is a stair of its cells. Each pair of neighbours counts in the grid that holds its first as an inner place.
/// @param area    x and y count from its lower left corner, rounded to 0.001; at most 2000 km wide and high
/// @param common  the other columns
void points_of_grid(const PointGrid& grid, const std::optional<StepWalls>& walls, const Bounds2& area, const LasPoint& common,
                    const std::function<void(std::vector<LasPoint>& points)>& visit);
/// The points of walls alone.
void walls_of_grid(const PointGrid& grid, const StepWalls& walls, const Bounds2& area, const LasPoint& common, const std::function<void(std::vector<LasPoint>& points)>& visit);

}  // namespace priormap
