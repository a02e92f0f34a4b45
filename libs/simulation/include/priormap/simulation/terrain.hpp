#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// Ground of the simulated world, frame `map`: a grid of heights, each cell split into two triangles. `height` is the height of
/// those triangles, so that a ray against `mesh` and `height` agree.
class Terrain {
 public:
  Terrain(const Bounds2& bounds, double cell_m, const std::function<double(const Eigen::Vector2d&)>& height_m);

  /// Outside the bounds: the height at the nearest edge.
  double height(const Eigen::Vector2d& p_map) const;
  double height(double x, double y) const { return height(Eigen::Vector2d(x, y)); }
  Bounds2 bounds() const;
  double cell_m() const { return cell_m_; }

  /// Triangles of the cells whose centre is `wanted`.
  TriangleMesh mesh(const std::function<bool(const Eigen::Vector2d&)>& wanted) const;

 private:
  double at(std::size_t column, std::size_t row) const { return heights_[row * columns_ + column]; }
  double min_x_, min_y_, cell_m_;
  std::size_t columns_, rows_;     ///< of vertices
  std::vector<double> heights_;
};

using Relief = std::function<double(const Eigen::Vector2d&)>;

/// Smooth ground height that follows known points (a road) and levels out away from them: push-pull interpolation (Gortler et al.
/// 1996, sec. 3.4) over 4 m cells, smoothed over about 15 m.
/// @param points  at least one [m, map]
Relief relief_through(const std::vector<Eigen::Vector3d>& points, const Bounds2& bounds);

/// Rolling ground around `base_m`: waves of 150 m to 600 m, `amplitude_m` high at most.
Relief rolling_relief(double base_m, double amplitude_m, std::uint64_t seed);

}  // namespace priormap
