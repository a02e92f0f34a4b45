#include <priormap/simulation/town.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace priormap {
namespace {

/// Oriented rectangle around a ring.
struct Rectangle {
  Eigen::Vector2d centre, axis;
  double half_length = 0, half_width = 0;   ///< along and across the axis
};

Rectangle rectangle_along(const Ring2& ring, const Eigen::Vector2d& axis) {
  const Eigen::Vector2d across(-axis.y(), axis.x());
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector2d& p : ring) {
    const Eigen::Array2d q(axis.dot(p), across.dot(p));
    low = low.min(q);
    high = high.max(q);
  }
  const Eigen::Array2d middle = 0.5 * (low + high), half = 0.5 * (high - low);
  return {middle.x() * axis + middle.y() * across, axis, half.x(), half.y()};
}

/// Plane through eaves_z on the line at `distance` from `centre` in `direction`, rising inwards.
RoofPlane rising_from(const Eigen::Vector2d& centre, const Eigen::Vector2d& direction, double distance, double eaves_z,
                      double pitch) {
  const Eigen::Vector2d slope = -pitch * direction;
  return {slope, eaves_z - slope.dot(centre + distance * direction)};
}

bool slopes_to_all_sides(RoofShape shape) {
  return shape == RoofShape::hipped || shape == RoofShape::half_hipped || shape == RoofShape::pyramidal || shape == RoofShape::cone ||
         shape == RoofShape::dome || shape == RoofShape::onion;
}

}  // namespace

double Building::roof_height(const Eigen::Vector2d& p) const {
  double z = std::numeric_limits<double>::infinity();
  for (const RoofPlane& plane : roof) z = std::min(z, plane.height(p));
  return z;
}

double Building::top_z() const {
  // The lowest of planes is concave: its maximum lies on the ridge. Every pair of planes meets in a line; sample it
  // where it crosses the outline, and take the corners of hips where three planes meet inside.
  double top = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : outline.exterior) top = std::max(top, roof_height(p));
  for (std::size_t i = 0; i < roof.size(); ++i)
    for (std::size_t j = i + 1; j < roof.size(); ++j) {
      for (std::size_t k = 0; k < outline.exterior.size(); ++k) {
        const Eigen::Vector2d a = outline.exterior[k], b = outline.exterior[(k + 1) % outline.exterior.size()];
        const double da = roof[i].height(a) - roof[j].height(a), db = roof[i].height(b) - roof[j].height(b);
        if (da * db < 0) top = std::max(top, roof_height(a + da / (da - db) * (b - a)));
      }
      for (std::size_t k = j + 1; k < roof.size(); ++k) {
        Eigen::Matrix2d normal;
        normal << (roof[i].slope - roof[j].slope).transpose(), (roof[i].slope - roof[k].slope).transpose();
        if (std::abs(normal.determinant()) < 1e-9) continue;
        const Eigen::Vector2d p = normal.inverse() * Eigen::Vector2d(roof[j].z0 - roof[i].z0, roof[k].z0 - roof[i].z0);
        if (contains(outline, p)) top = std::max(top, roof_height(p));
      }
    }
  return top;
}

Eigen::Vector2d main_axis(const Ring2& ring) {
  Eigen::Vector2d best = Eigen::Vector2d::UnitX();
  double best_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d edge = ring[(i + 1) % ring.size()] - ring[i];
    if (edge.norm() < 1e-6) continue;
    const Eigen::Vector2d along = edge.normalized();
    const Rectangle box = rectangle_along(ring, along);
    if (box.half_length * box.half_width >= best_area) continue;
    best_area = box.half_length * box.half_width;
    best = box.half_length >= box.half_width ? along : Eigen::Vector2d(-along.y(), along.x());
  }
  return best;
}

std::vector<RoofPlane> roof_planes(const Ring2& outline, RoofShape shape, const Eigen::Vector2d& ridge, double eaves_z, double pitch) {
  if (shape == RoofShape::flat || shape == RoofShape::other) return {{Eigen::Vector2d::Zero(), eaves_z}};
  const Rectangle box = rectangle_along(outline, ridge);
  const Eigen::Vector2d across(-box.axis.y(), box.axis.x());
  if (shape == RoofShape::skillion) return {rising_from(box.centre, across, box.half_width, eaves_z, 0.5 * pitch)};
  std::vector<RoofPlane> planes{rising_from(box.centre, across, box.half_width, eaves_z, pitch),
                                rising_from(box.centre, -across, box.half_width, eaves_z, pitch)};
  if (slopes_to_all_sides(shape)) {
    planes.push_back(rising_from(box.centre, box.axis, box.half_length, eaves_z, pitch));
    planes.push_back(rising_from(box.centre, -box.axis, box.half_length, eaves_z, pitch));
  }
  return planes;
}

void place_on_ground(Building& building, const Terrain& terrain, double eaves_height_m, const Eigen::Vector2d& ridge, double pitch) {
  constexpr double foundation_m = 1.0;
  std::vector<double> ground;
  const Ring2& ring = building.outline.exterior;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d edge = ring[(i + 1) % ring.size()] - ring[i];
    const int steps = std::max(1, static_cast<int>(edge.norm()));
    for (int k = 0; k < steps; ++k) ground.push_back(terrain.height(ring[i] + edge * k / steps));
  }
  std::sort(ground.begin(), ground.end());
  building.ground_z = ground[ground.size() / 2];
  building.base_z = ground.front() - foundation_m;
  building.eaves_z = std::max(building.ground_z + eaves_height_m, ground.back() + 1.0);
  building.roof = roof_planes(ring, building.roof_shape, ridge, building.eaves_z, pitch);
}

}  // namespace priormap
