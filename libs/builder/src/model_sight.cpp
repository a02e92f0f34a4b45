#include "model_sight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <priormap/tessellation/triangulate.hpp>

#include "drive_axis.hpp"

namespace priormap {
namespace {

constexpr double foot_m = 1;   // vertices within this of a building's lowest stand on the ground
constexpr double square_m = 5;

std::pair<int, int> square_of(const Eigen::Vector2d& place) {
  const Eigen::Vector2d square = (place / square_m).array().floor();
  return {static_cast<int>(square.x()), static_cast<int>(square.y())};
}

}  // namespace

void ModelSight::add(const std::vector<ModelFace>& faces) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const ModelFace& face : faces) {
    if (face.surface_class != SurfaceClass::closure && !face.repeated) occluders_.append(triangulate(face.polygon));
    for (const Eigen::Vector3d& p : face.polygon.exterior) lowest = std::min(lowest, p.z());
  }
  for (const ModelFace& face : faces)
    for (const Eigen::Vector3d& p : face.polygon.exterior) {
      if (p.z() > lowest + foot_m) continue;
      double& z = feet_z_.try_emplace(square_of(p.head<2>()), p.z()).first->second;
      z = std::min(z, p.z());
    }
}

/// Of the nearest squares around that hold a foot the lowest.
std::optional<double> ModelSight::ground_z(const Eigen::Vector2d& place) const {
  const auto [x, y] = square_of(place);
  const int reach = static_cast<int>(std::ceil(options_.view_range_m / square_m));
  std::optional<double> z;
  for (int ring = 0; ring <= reach && !z; ++ring)
    for (int i = x - ring; i <= x + ring; ++i)
      for (int j = y - ring; j <= y + ring; j += std::abs(i - x) == ring ? 1 : std::max(1, 2 * ring)) {
        const auto foot = feet_z_.find({i, j});
        if (foot != feet_z_.end()) z = std::min(z.value_or(foot->second), foot->second);
      }
  return z;
}

LineOfSight ModelSight::finish(const Crs& prior) {
  std::vector<Eigen::Vector3d> viewpoints;
  for (const Eigen::Vector2d& place : places_along_axis(options_.visible_from, prior)) {
    const std::optional<double> z = ground_z(place);
    viewpoints.emplace_back(place.x(), place.y(), z ? *z + options_.sensor_height_m : std::numeric_limits<double>::quiet_NaN());
  }
  LineOfSight sight(std::move(viewpoints), occluders_, options_.view_range_m);
  occluders_ = {};
  feet_z_ = {};
  return sight;
}

}  // namespace priormap
