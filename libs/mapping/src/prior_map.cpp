#include <priormap/mapping/prior_map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace priormap {
namespace {

double distance(const Bounds2& b, double x, double y) {
  return std::hypot(std::max({b.min_x - x, 0.0, x - b.max_x}), std::max({b.min_y - y, 0.0, y - b.max_y}));
}

double unit_m(const PriorPoints& points) { return points.crs() ? points.crs()->horizontal_unit_m() : 1.0; }

}  // namespace

PointCloud tile_in_map(const PriorPoints& points, TileKey key, const MapFrame& frame) {
  PointCloud cloud = points.load(key);
  if (!frame.georeferenced() || cloud.empty()) return cloud;
  std::vector<Eigen::Vector3d> positions(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) positions[i] = cloud.position(i);
  frame.to_map(positions);
  cloud.origin = positions.front();
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.xyz[i] = (positions[i] - cloud.origin).cast<float>();
  if (!cloud.normal.empty()) {
    const Eigen::Matrix3f R = Eigen::AngleAxisd(-frame.grid_rotation(cloud.origin), Eigen::Vector3d::UnitZ()).toRotationMatrix().cast<float>();
    for (auto& n : cloud.normal) n = R * n;
  }
  return cloud;
}

double distance_to_prior_m(const PriorPoints& points, const Eigen::Vector3d& projected) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const TileKey key : points.tiles()) nearest = std::min(nearest, distance(points.grid().bounds(key), projected.x(), projected.y()));
  return nearest * unit_m(points);
}

PriorMap::PriorMap(const PriorPoints& points, const MapFrame& frame, const VoxelHashMapOptions& voxels, double radius_m)
    : points_(points), frame_(frame), radius_m_(radius_m), voxels_(voxels) {}

Bounds2 PriorMap::bounds_around(const Eigen::Vector3d& p_map, double radius_m) const {
  const Eigen::Vector3d p = frame_.georeferenced() ? frame_.to_projected(p_map) : p_map;
  const double r = radius_m / unit_m(points_);
  return {p.x() - r, p.y() - r, p.x() + r, p.y() + r};
}

const VoxelHashMap& PriorMap::around(const Eigen::Vector3d& p_map) {
  const double tile_m = points_.grid().tile_size() * unit_m(points_);
  // A tile is dropped as a whole, once it lies half a tile beyond the radius: driving along its edge does not load it again and again.
  const double drop_m = radius_m_ + 0.5 * tile_m;
  const auto kept = points_.tiles_within(bounds_around(p_map, drop_m));
  std::erase_if(held_, [&](const TileKey& key) { return !std::binary_search(kept.begin(), kept.end(), key); });
  voxels_.remove_beyond(p_map, std::numbers::sqrt2 * (drop_m + tile_m) + std::numbers::sqrt2 * voxels_.options().voxel_m);
  for (const TileKey& key : points_.tiles_within(bounds_around(p_map, radius_m_)))
    if (held_.insert(key).second) voxels_.insert(tile_in_map(points_, key, frame_));
  return voxels_;
}

}  // namespace priormap
