#pragma once
#include <Eigen/Core>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/tessellation/polygon.hpp>

namespace priormap {

/// Distance to the nearest of many lines on a grid of 1 m, up to `reach_m`.
class DistanceField {
 public:
  DistanceField(const Bounds2& bounds, double reach_m);
  /// @param less  taken off the distance: half the width of a street gives the distance to its edge
  void add(const std::vector<Eigen::Vector2d>& line, double less = 0);
  /// Between cells linearly; `reach_m` where nothing is near.
  double distance(const Eigen::Vector2d& p) const;

 private:
  void add_segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double less);
  double min_x_, min_y_, reach_m_;
  std::size_t columns_, rows_;
  std::vector<float> cells_;
};

/// Which half-metre cells are taken by something.
class Occupancy {
 public:
  explicit Occupancy(const Bounds2& bounds);
  void add(const Ring2& ring);
  void add_disc(const Eigen::Vector2d& centre, double radius_m);
  /// True where a taken cell's centre lies within the ring / the disc, or the ring leaves the bounds.
  bool touches(const Ring2& ring) const;
  bool touches_disc(const Eigen::Vector2d& centre, double radius_m) const;

 private:
  template <class Inside, class Visit>
  bool visit_cells(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Inside& inside, const Visit& visit) const;
  Bounds2 bounds_;
  std::size_t columns_, rows_;
  std::vector<bool> taken_;
};

}  // namespace priormap
