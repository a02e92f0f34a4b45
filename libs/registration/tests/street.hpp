#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <priormap/pointcloud/point_cloud.hpp>
#include <random>
#include <vector>

/// A street made of planes, seen by a spinning laser: truth for the registration tests, with its own ray casting.
namespace priormap::street {

inline Eigen::Isometry3d pose(double x, double y, double z, double yaw) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

/// A rectangle corner + a u + b v, a and b in [0, 1]; the normal is u x v.
struct Rectangle {
  Eigen::Vector3d corner, u, v;
  Eigen::Vector3d normal() const { return u.cross(v).normalized(); }
};

struct World {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Rectangle> faces;

  /// A box standing on the ground, turned by yaw; its four walls face outwards.
  void add_box(double x, double y, double length, double width, double height, double yaw) {
    const Eigen::Vector3d a = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(length, 0, 0);
    const Eigen::Vector3d b = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(0, width, 0);
    const Eigen::Vector3d up(0, 0, height), c = origin + Eigen::Vector3d(x, y, 0) - 0.5 * (a + b);
    faces.push_back({c, a, up});
    faces.push_back({c + a, b, up});
    faces.push_back({c + a + b, -a, up});
    faces.push_back({c + b, -b, up});
    faces.push_back({c + up, a, b});
  }
  void add_ground(double x0, double y0, double x1, double y1) {
    faces.push_back({origin + Eigen::Vector3d(x0, y0, 0), Eigen::Vector3d(x1 - x0, 0, 0), Eigen::Vector3d(0, y1 - y0, 0)});
  }
};

/// Buildings of different length, depth and gap on both sides of a street along x.
inline World town(double length, unsigned seed, const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) {
  World world;
  world.origin = origin;
  world.add_ground(-100, -100, length + 100, 100);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  for (const double side : {-1.0, 1.0})
    for (double x = -80; x < length + 80;) {
      // One by one: the order in which arguments are evaluated differs between machines.
      const double front = 10 + 15 * u(random), depth = 8 + 6 * u(random), setback = 8 + 5 * u(random), yaw = 0.06 * (u(random) - 0.5), height = 6 + 9 * u(random);
      world.add_box(x + 0.5 * front, side * (setback + 0.5 * depth), front, depth, height, yaw);
      x += front + 2 + 8 * u(random);
    }
  return world;
}

/// Houses far from the road: most of a scan is ground.
inline World wide_street() {
  World world;
  world.add_ground(-100, -100, 100, 100);
  for (const double side : {-1.0, 1.0})
    for (int i = -3; i <= 3; ++i) world.add_box(20 * i + 5 * side, side * (25 + std::abs(i) % 2), 12 + i, 10, 7, 0.03 * i);
  return world;
}

/// Two endless walls and a road: nothing tells where along it one is.
inline World canyon() {
  World world;
  world.add_ground(-300, -10, 300, 10);
  world.faces.push_back({{-300, 10, 0}, {600, 0, 0}, {0, 0, 12}});
  world.faces.push_back({{300, -10, 0}, {-600, 0, 0}, {0, 0, 12}});
  return world;
}

/// The same with some piers before the walls, at uneven distances: they alone tell where along it one is.
inline World canyon_with_piers() {
  World world = canyon();
  const double at[] = {-93, -71, -58, -33, -19, 4, 23, 47, 61, 88, 101, 127, 146, 163, 190, 204};
  int i = 0;
  for (const double x : at) world.add_box(x, ++i % 2 ? 9.2 : -9.2, 1.5, 1.6, 5, 0);
  return world;
}

/// Points every `spacing_m` on all faces, with normals and `sigma_m`: a prior.
inline PointCloud sample(const World& world, double spacing_m, float sigma_m) {
  PointCloud cloud;
  cloud.origin = world.origin;
  for (const Rectangle& face : world.faces) {
    const int across = int(face.u.norm() / spacing_m), up = int(face.v.norm() / spacing_m);
    for (int i = 0; i <= across; ++i)
      for (int j = 0; j <= up; ++j) {
        const Eigen::Vector3d p = face.corner + face.u * ((i + 0.5) / (across + 1)) + face.v * ((j + 0.5) / (up + 1));
        cloud.xyz.push_back((p - cloud.origin).cast<float>());
        cloud.normal.push_back(face.normal().cast<float>());
        cloud.sigma_m.push_back(sigma_m);
      }
  }
  return cloud;
}

struct Laser {
  int rings = 64;
  int columns = 1000;
  double lowest_rad = -0.43, highest_rad = 0.035, range_m = 100;
  double noise_m = 0.02;
};

/// A HDL-32: so many points a ring that the rings are lines.
constexpr Laser hdl32{.rings = 32, .columns = 2100, .lowest_rad = -0.535, .highest_rad = 0.186, .noise_m = 0.015};

/// A VLP-16: two degrees between its lasers.
constexpr Laser vlp16{.rings = 16, .columns = 1800, .lowest_rad = -0.262, .highest_rad = 0.262};

/// One scan in the sensor's frame.
inline PointCloud scan(const World& world, const Eigen::Isometry3d& T_map_sensor, const Laser& laser, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  PointCloud cloud;
  const Eigen::Vector3d eye = T_map_sensor.translation();
  std::vector<Rectangle> near;
  for (const Rectangle& face : world.faces)
    if ((face.corner + 0.5 * (face.u + face.v) - eye).norm() < laser.range_m + 0.5 * (face.u + face.v).norm() && face.normal().dot(eye - face.corner) > 0)
      near.push_back(face);
  for (int c = 0; c < laser.columns; ++c)
    for (int r = 0; r < laser.rings; ++r) {
      const double azimuth = 2 * M_PI * c / laser.columns;
      const double elevation = laser.lowest_rad + (laser.highest_rad - laser.lowest_rad) * r / std::max(1, laser.rings - 1);
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d d = T_map_sensor.linear() * direction;
      double best = laser.range_m;
      for (const Rectangle& face : near) {
        const Eigen::Vector3d n = face.u.cross(face.v);
        const double t = n.dot(face.corner - eye) / n.dot(d);
        if (!(t > 0.5) || t >= best) continue;
        const Eigen::Vector3d p = eye + t * d - face.corner;
        const double a = p.dot(face.u) / face.u.squaredNorm(), b = p.dot(face.v) / face.v.squaredNorm();
        if (a >= 0 && a <= 1 && b >= 0 && b <= 1) best = t;
      }
      if (best < laser.range_m) cloud.xyz.push_back(((best + laser.noise_m * noise(random)) * direction).cast<float>());
    }
  return cloud;
}

inline double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) { return (a.translation() - b.translation()).norm(); }
inline double angle(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

}  // namespace priormap::street
