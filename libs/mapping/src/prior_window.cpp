#include <priormap/mapping/prior_window.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <priormap/core/symmetric.hpp>

namespace priormap {
namespace {

/// How offsets from `origin` in units of the prior's CRS lie in `map`, as seen over one tile.
Eigen::Affine3d affine_to_map(const Eigen::Vector3d& origin, const PriorPoints& points, const MapFrame& frame) {
  const double edge = points.grid().tile_size();
  std::array<Eigen::Vector3d, 4> corners;
  for (int i = 0; i < 4; ++i) corners[std::size_t(i)] = origin + edge * Eigen::Vector3d(i & 1, i >> 1, 0);
  frame.to_map(corners);
  Eigen::Affine3d A = Eigen::Affine3d::Identity();
  A.linear().col(0) = (corners[1] - corners[0] + corners[3] - corners[2]) / (2 * edge);
  A.linear().col(1) = (corners[2] - corners[0] + corners[3] - corners[1]) / (2 * edge);
  A.linear().col(2) = Eigen::Vector3d(0, 0, points.units().vertical_m);
  A.translation() = corners[0];
  return A;
}

}  // namespace

PointCloud tile_in_map(PointCloud tile, const PriorPoints& points, const MapFrame& frame) {
  if (!frame.georeferenced()) return tile;
  const Eigen::Affine3d A = affine_to_map(tile.origin, points, frame);
  const Eigen::Matrix3f linear = A.linear().cast<float>(), of_normals = linear.inverse().transpose();
  tile.origin = A.translation();
  for (auto& p : tile.xyz) p = linear * p;
  for (auto& n : tile.normal) n = (of_normals * n).normalized();
  return tile;
}

PatchCloud tile_in_map(PatchCloud tile, const PriorPoints& points, const MapFrame& frame) {
  if (!frame.georeferenced()) return tile;
  const Eigen::Affine3d A = affine_to_map(tile.origin, points, frame);
  const PriorUnits units = points.units();
  const Eigen::Vector3d units_per_m = Eigen::Vector3d(units.horizontal_m, units.horizontal_m, units.vertical_m).cwiseInverse();
  const Eigen::Matrix3f linear = (A.linear() * units_per_m.asDiagonal()).cast<float>(), of_normals = linear.inverse().transpose();
  tile.origin = A.translation();
  for (SurfacePatch& patch : tile.patches) {
    patch.mean = linear * patch.mean;
    patch.normal = (of_normals * patch.normal).normalized();
    patch.covariance = turned(patch.covariance, linear);
  }
  return tile;
}

/// A tile is dropped as a whole, once it lies half a tile beyond the radius: driving along its edge does not load it again and again.
double NearTiles::drop_m() const { return radius_m_ + 0.5 * points_->grid().tile_size() * points_->units().horizontal_m; }

double NearTiles::reach_m() const {
  constexpr double margin_m = 20;   // maps drop by blocks
  return drop_m() + std::numbers::sqrt2 * points_->grid().tile_size() * points_->units().horizontal_m + margin_m;
}

std::vector<TileKey> NearTiles::within(const Eigen::Vector3d& p_map, double radius_m) const {
  const Eigen::Vector3d p = frame_.georeferenced() ? frame_.to_projected(p_map) : p_map;
  const double r = radius_m / points_->units().horizontal_m;
  auto keys = points_->tiles_within({p.x() - r, p.y() - r, p.x() + r, p.y() + r});
  std::erase_if(keys, [&](const TileKey& key) { return distance(points_->grid().bounds(key), p.x(), p.y()) > r; });
  return keys;
}

std::vector<TileKey> NearTiles::move_to(const Eigen::Vector3d& p_map) {
  const auto kept = within(p_map, drop_m());
  std::erase_if(held_, [&](const TileKey& key) { return !std::binary_search(kept.begin(), kept.end(), key); });
  std::vector<TileKey> arrived;
  for (const TileKey& key : within(p_map, radius_m_))
    if (held_.insert(key).second) arrived.push_back(key);
  return arrived;
}

void NearTiles::exchange(StateArchive& archive) {
  std::vector<TileKey> held(held_.begin(), held_.end());
  archive(held);
  held_ = {held.begin(), held.end()};
}

std::vector<TileKey> NearTiles::lacking_at(const Eigen::Vector3d& p_map) const {
  auto keys = within(p_map, radius_m_);
  std::erase_if(keys, [&](const TileKey& key) { return held_.contains(key); });
  return keys;
}

}  // namespace priormap
