#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include <priormap/mapping/prior_points.hpp>
#include <priormap/mapping/scan.hpp>

namespace priormap::test {

/// A street of house fronts with gaps and set-backs on flat ground: points anywhere on its surfaces, some 14 a square metre, in the frame `map`.
/// Another seed gives other points of the same surfaces.
inline std::vector<Eigen::Vector3d> street(double length_m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0, 1);
  std::vector<Eigen::Vector3d> points;
  const auto sample = [&](const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v, double density) {
    const auto n = static_cast<std::size_t>(u.norm() * v.norm() * density);
    for (std::size_t i = 0; i < n; ++i) points.push_back(corner + part(random) * u + part(random) * v);
  };
  int house = 0;
  for (double x = -40; x < length_m + 40; x += 18, ++house) {
    const double width = 11 + house * 5 % 4;
    const Eigen::Vector3d up(0, 0, 6 + house % 3);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d front(x, side * (9 + house * 7 % 5), 0), deep(0, side * 10, 0), wide(width, 0, 0);
      sample(front, wide, up, 14);
      sample(front, deep, up, 14);
      sample(front + wide, deep, up, 14);
    }
  }
  sample({-40, -20, 0}, {length_m + 80, 0, 0}, {0, 40, 0}, 5);
  return points;
}

/// What a sensor at `T_map_sensor` measures of such a street: everything within 40 m (walls are see-through here), with 1 cm of noise.
inline Scan scan_from(double length_m, const Eigen::Isometry3d& T_map_sensor, std::size_t index) {
  std::mt19937 random(static_cast<unsigned>(index));
  std::normal_distribution<double> noise(0, 0.01);
  Scan scan;
  scan.index = index;
  scan.stamp_s = 0.1 * static_cast<double>(index);
  const Eigen::Isometry3d T_sensor_map = T_map_sensor.inverse();
  for (const auto& p : street(length_m, 100 + static_cast<unsigned>(index))) {
    if ((p - T_map_sensor.translation()).norm() > 40) continue;
    const Eigen::Vector3d q = T_sensor_map * p + Eigen::Vector3d(noise(random), noise(random), noise(random));
    scan.points.xyz.push_back(q.cast<float>());
  }
  return scan;
}

/// Points in tiles, in a local metric frame.
class TiledPoints : public PriorPoints {
 public:
  TiledPoints(const std::vector<Eigen::Vector3d>& points, double tile_size) : grid_(tile_size) {
    for (const auto& p : points) {
      PointCloud& tile = tiles_[grid_.key(p.x(), p.y())];
      if (tile.empty()) tile.origin = p;
      tile.xyz.push_back((p - tile.origin).cast<float>());
    }
  }
  /// With their normals.
  TiledPoints(const PointCloud& points, double tile_size) : grid_(tile_size) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p = points.position(i);
      PointCloud& tile = tiles_[grid_.key(p.x(), p.y())];
      if (tile.empty()) tile.origin = p;
      tile.xyz.push_back((p - tile.origin).cast<float>());
      tile.normal.push_back(points.normal[i]);
    }
  }
  const std::optional<Crs>& crs() const override { return none_; }
  const TileGrid& grid() const override { return grid_; }
  std::vector<TileKey> tiles_within(const Bounds2& b) const override {
    std::vector<TileKey> keys;
    for (const auto& [key, tile] : tiles_) {
      const Bounds2 t = grid_.bounds(key);
      if (t.max_x > b.min_x && t.min_x < b.max_x && t.max_y > b.min_y && t.min_y < b.max_y) keys.push_back(key);
    }
    return keys;
  }
  PointCloud load(TileKey key) const override { return tiles_.at(key); }
  const PriorIdentity& identity() const override { return identity_; }

 private:
  TileGrid grid_;
  std::optional<Crs> none_;
  std::map<TileKey, PointCloud> tiles_;
  PriorIdentity identity_;
};

inline Eigen::Isometry3d pose(double x, double y, double z, double yaw) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << x, y, z;
  return T;
}

}  // namespace priormap::test
