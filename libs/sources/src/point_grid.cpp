#include "point_grid.hpp"

#include <Eigen/Geometry>

namespace priormap {
namespace {

/// Beyond this difference of slope between its two sides a cell lies on a step, such as a roof's edge.
constexpr double step_slope = 1;

double rounded(double v) { return std::floor(v * 1000 + 0.5) / 1000; }

Eigen::Vector3d position(const PointGrid& grid, std::size_t i) { return {grid.x[i], grid.y[i], grid.z[i]}; }

/// The surface's direction at a point along one axis of the grid, from the point before and the point after; zero where neither is known.
Eigen::Vector3d tangent(const Eigen::Vector3d& before, const Eigen::Vector3d& p, const Eigen::Vector3d& after) {
  const bool has_before = !std::isnan(before.z()), has_after = !std::isnan(after.z());
  if (has_before && has_after) {
    const Eigen::Vector3d in = p - before, out = after - p;
    const double in_length = in.head<2>().norm(), out_length = out.head<2>().norm();
    const double in_slope = in.z() / in_length, out_slope = out.z() / out_length;
    if (std::abs(in_slope - out_slope) <= step_slope) return in + out;
    return std::abs(in_slope) < std::abs(out_slope) ? in : out;
  }
  if (has_before) return p - before;
  if (has_after) return after - p;
  return Eigen::Vector3d::Zero();
}

Eigen::Vector3f normal_at(const PointGrid& grid, std::size_t i) {
  const Eigen::Vector3d p = position(grid, i);
  const Eigen::Vector3d along = tangent(position(grid, i - 1), p, position(grid, i + 1));
  const Eigen::Vector3d down = tangent(position(grid, i - grid.width), p, position(grid, i + grid.width));
  const Eigen::Vector3d normal = along.cross(down);
  const double length = normal.norm();
  if (!(length > 0)) return Eigen::Vector3f::Zero();
  return (normal * ((normal.z() < 0 ? -1 : 1) / length)).cast<float>();
}

}  // namespace

void PointGrid::resize(std::size_t new_width, std::size_t new_height) {
  width = new_width;
  height = new_height;
  x.resize(size());
  y.resize(size());
  z.resize(size());
}

PointCloud points_of_grid(const PointGrid& grid) {
  PointCloud points;
  if (grid.width < 3 || grid.height < 3) return points;
  points.xyz.reserve((grid.width - 2) * (grid.height - 2));
  points.normal.reserve(points.xyz.capacity());
  for (std::size_t col = 1; col + 1 < grid.width; ++col) {
    for (std::size_t row = grid.height - 2; row > 0; --row) {
      const std::size_t i = row * grid.width + col;
      if (std::isnan(grid.z[i])) continue;
      if (points.empty()) points.origin = position(grid, i).array().round();
      const Eigen::Vector3d p(rounded(grid.x[i]), rounded(grid.y[i]), rounded(grid.z[i]));
      points.xyz.push_back((p - points.origin).cast<float>());
      points.normal.push_back(normal_at(grid, i));
    }
  }
  return points;
}

}  // namespace priormap
