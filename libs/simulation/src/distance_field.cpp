#include "distance_field.hpp"

#include <algorithm>
#include <cmath>

namespace priormap {
namespace {

constexpr double occupancy_cell_m = 0.5;

std::size_t cells_along(double extent_m, double cell_m) { return static_cast<std::size_t>(std::ceil(extent_m / cell_m)) + 1; }

}  // namespace

DistanceField::DistanceField(const Bounds2& bounds, double reach_m)
    : min_x_(bounds.min_x), min_y_(bounds.min_y), reach_m_(reach_m), columns_(cells_along(bounds.max_x - bounds.min_x, 1)),
      rows_(cells_along(bounds.max_y - bounds.min_y, 1)), cells_(columns_ * rows_, static_cast<float>(reach_m)) {}

void DistanceField::add(const std::vector<Eigen::Vector2d>& line, double less) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) add_segment(line[i], line[i + 1], less);
}

void DistanceField::add_segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double less) {
  const double reach = reach_m_ + less;
  const auto clamp = [](double v, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(v, 0.0, static_cast<double>(count)));
  };
  const Eigen::Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b), run = b - a;
  const std::size_t c0 = clamp(std::floor(low.x() - min_x_ - reach), columns_), c1 = clamp(std::ceil(high.x() - min_x_ + reach) + 1, columns_);
  const std::size_t r0 = clamp(std::floor(low.y() - min_y_ - reach), rows_), r1 = clamp(std::ceil(high.y() - min_y_ + reach) + 1, rows_);
  const double length2 = std::max(run.squaredNorm(), 1e-12);
  for (std::size_t r = r0; r < r1; ++r)
    for (std::size_t c = c0; c < c1; ++c) {
      const Eigen::Vector2d p(min_x_ + static_cast<double>(c), min_y_ + static_cast<double>(r));
      const double t = std::clamp((p - a).dot(run) / length2, 0.0, 1.0);
      float& cell = cells_[r * columns_ + c];
      cell = std::min(cell, static_cast<float>((p - a - t * run).norm() - less));
    }
}

double DistanceField::distance(const Eigen::Vector2d& p) const {
  const double x = std::clamp(p.x() - min_x_, 0.0, static_cast<double>(columns_ - 1) - 1e-9);
  const double y = std::clamp(p.y() - min_y_, 0.0, static_cast<double>(rows_ - 1) - 1e-9);
  const auto c = static_cast<std::size_t>(x), r = static_cast<std::size_t>(y);
  const double u = x - static_cast<double>(c), v = y - static_cast<double>(r);
  const auto at = [&](std::size_t i, std::size_t j) { return static_cast<double>(cells_[j * columns_ + i]); };
  return (1 - v) * ((1 - u) * at(c, r) + u * at(c + 1, r)) + v * ((1 - u) * at(c, r + 1) + u * at(c + 1, r + 1));
}

Occupancy::Occupancy(const Bounds2& bounds)
    : bounds_(bounds), columns_(cells_along(bounds.max_x - bounds.min_x, occupancy_cell_m)),
      rows_(cells_along(bounds.max_y - bounds.min_y, occupancy_cell_m)), taken_(columns_ * rows_, false) {}

/// Calls visit(index) for the cells inside until it returns true.
template <class Inside, class Visit>
bool Occupancy::visit_cells(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Inside& inside, const Visit& visit) const {
  const auto index = [](double v, double min, std::size_t count) {
    return static_cast<std::size_t>(std::clamp((v - min) / occupancy_cell_m, 0.0, static_cast<double>(count - 1)));
  };
  for (std::size_t r = index(low.y(), bounds_.min_y, rows_); r <= index(high.y(), bounds_.min_y, rows_); ++r)
    for (std::size_t c = index(low.x(), bounds_.min_x, columns_); c <= index(high.x(), bounds_.min_x, columns_); ++c) {
      const Eigen::Vector2d centre(bounds_.min_x + (static_cast<double>(c) + 0.5) * occupancy_cell_m,
                                   bounds_.min_y + (static_cast<double>(r) + 0.5) * occupancy_cell_m);
      if (inside(centre) && visit(r * columns_ + c)) return true;
    }
  return false;
}

namespace {

std::pair<Eigen::Vector2d, Eigen::Vector2d> box_around(const Ring2& ring) {
  Eigen::Vector2d low = ring.front(), high = ring.front();
  for (const Eigen::Vector2d& p : ring) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {low, high};
}

}  // namespace

void Occupancy::add(const Ring2& ring) {
  const auto [low, high] = box_around(ring);
  const Polygon2 polygon{ring, {}};
  visit_cells(low, high, [&](const Eigen::Vector2d& p) { return contains(polygon, p); },
              [&](std::size_t i) { taken_[i] = true; return false; });
}

void Occupancy::add_disc(const Eigen::Vector2d& centre, double radius_m) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius_m);
  visit_cells(centre - reach, centre + reach, [&](const Eigen::Vector2d& p) { return (p - centre).norm() <= radius_m; },
              [&](std::size_t i) { taken_[i] = true; return false; });
}

bool Occupancy::touches(const Ring2& ring) const {
  const auto [low, high] = box_around(ring);
  if (!bounds_.contains(low.x(), low.y()) || !bounds_.contains(high.x(), high.y())) return true;
  const Polygon2 polygon{ring, {}};
  return visit_cells(low, high, [&](const Eigen::Vector2d& p) { return contains(polygon, p); },
                     [&](std::size_t i) { return static_cast<bool>(taken_[i]); });
}

bool Occupancy::touches_disc(const Eigen::Vector2d& centre, double radius_m) const {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius_m);
  return visit_cells(centre - reach, centre + reach, [&](const Eigen::Vector2d& p) { return (p - centre).norm() <= radius_m; },
                     [&](std::size_t i) { return static_cast<bool>(taken_[i]); });
}

}  // namespace priormap
