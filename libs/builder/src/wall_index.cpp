#include "wall_index.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include <priormap/pointcloud/slope.hpp>

namespace priormap {

std::int64_t WallIndex::cell(double x, double y) {
  return (static_cast<std::int64_t>(std::floor(x / cell_m)) << 32) ^ (static_cast<std::int64_t>(std::floor(y / cell_m)) & 0xffffffff);
}

void WallIndex::add(const Polygon3& face, const Eigen::Vector3d& normal) {
  if (!is_wall(normal.z()) || face.exterior.size() < 3) return;
  Eigen::Vector2d low = face.exterior.front().head<2>(), high = low;
  for (const Eigen::Vector3d& p : face.exterior) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  if ((high - low).norm() > longest_wall_m) return;
  if (!has_origin_) {
    origin_ = face.exterior.front().array().round();
    has_origin_ = true;
  }
  Wall wall{normal.cast<float>(), static_cast<std::uint32_t>(vertices_.size()), 0};
  auto add_ring = [&](const Ring3& ring) {
    for (const Eigen::Vector3d& p : ring) vertices_.push_back((p - origin_).cast<float>());
    vertices_.push_back((ring.front() - origin_).cast<float>());
  };
  add_ring(face.exterior);
  for (const Ring3& hole : face.holes) {
    if (hole.empty()) continue;
    add_ring(hole);
    vertices_.push_back((face.exterior.front() - origin_).cast<float>());   // the way there and back cancels in the even-odd rule
  }
  wall.end = static_cast<std::uint32_t>(vertices_.size());

  const auto number = static_cast<std::uint32_t>(walls_.size());
  for (double x = std::floor((low.x() - touching_m) / cell_m) * cell_m; x <= high.x() + touching_m; x += cell_m) {
    for (double y = std::floor((low.y() - touching_m) / cell_m) * cell_m; y <= high.y() + touching_m; y += cell_m) cells_[cell(x, y)].push_back(number);
  }
  walls_.push_back(wall);
}

bool WallIndex::touches(const Wall& wall, const Eigen::Vector3f& normal, const Eigen::Vector3f& point) const {
  if (wall.normal.dot(normal) > -0.99f) return false;
  if (std::abs(wall.normal.dot(point - vertices_[wall.first])) > static_cast<float>(touching_m)) return false;
  // Even-odd along the wall and upward; a ray upward crosses the edges of all rings.
  const Eigen::Vector2f along = Eigen::Vector2f(-wall.normal.y(), wall.normal.x()).normalized();
  const float s = along.dot(point.head<2>());
  bool inside = false;
  for (std::uint32_t i = wall.first; i + 1 < wall.end; ++i) {
    const Eigen::Vector3f &a = vertices_[i], &b = vertices_[i + 1];
    const float sa = along.dot(a.head<2>()), sb = along.dot(b.head<2>());
    if ((sa > s) != (sb > s) && point.z() < a.z() + (s - sa) / (sb - sa) * (b.z() - a.z())) inside = !inside;
  }
  return inside;
}

void WallIndex::remove_shared(const Eigen::Vector3d& normal, std::vector<Eigen::Vector3d>& points) const {
  if (!is_wall(normal.z())) return;
  const Eigen::Vector3f direction = normal.cast<float>();
  std::erase_if(points, [&](const Eigen::Vector3d& p) {
    const auto found = cells_.find(cell(p.x(), p.y()));
    if (found == cells_.end()) return false;
    const Eigen::Vector3f local = (p - origin_).cast<float>();
    return std::any_of(found->second.begin(), found->second.end(), [&](std::uint32_t i) { return touches(walls_[i], direction, local); });
  });
}

}  // namespace priormap
