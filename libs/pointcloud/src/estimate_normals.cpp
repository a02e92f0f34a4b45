#include <priormap/pointcloud/estimate_normals.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace priormap {
namespace {

constexpr std::array radii_m = {0.5f, 1.0f, 2.0f, 4.0f};
constexpr int least_neighbours = 6;
constexpr float flatness = 0.05f;   // of the variance across the plane to the lesser one within it
constexpr float breadth = 0.05f;    // of the lesser to the greater variance within the plane: less is a line

/// Points by cubes of one edge; those of three neighbouring cubes along x lie in one run.
class Cubes {
 public:
  Cubes(const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint32_t>& members, const Eigen::Vector3f& low, float edge_m)
      : points_(&points), low_(low), edge_m_(edge_m) {
    sorted_.reserve(members.size());
    for (const std::uint32_t i : members) sorted_.push_back({key(cube_of(points[i])), i});
    std::sort(sorted_.begin(), sorted_.end());
  }

  template <class Visitor>
  void for_each_within(const Eigen::Vector3f& p, Visitor&& visit) const {
    const Eigen::Array3i cube = cube_of(p);
    for (int z = cube.z() - 1; z <= cube.z() + 1; ++z)
      for (int y = cube.y() - 1; y <= cube.y() + 1; ++y) {
        const std::uint64_t last = key({cube.x() + 1, y, z});
        auto it = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(key({cube.x() - 1, y, z}), std::uint32_t(0)));
        for (; it != sorted_.end() && it->first <= last; ++it)
          if (((*points_)[it->second] - p).squaredNorm() <= edge_m_ * edge_m_) visit((*points_)[it->second]);
      }
  }

 private:
  /// From 1 up, so that a neighbour never falls below 0; clouds wider than 2^20 cubes share some, and lose a little time.
  Eigen::Array3i cube_of(const Eigen::Vector3f& p) const { return ((p - low_) / edge_m_).array().floor().cast<int>() + 1; }
  static std::uint64_t key(const Eigen::Array3i& cube) {
    constexpr std::uint64_t mask = (1u << 21) - 1;
    return (std::uint64_t(cube.z()) & mask) << 42 | (std::uint64_t(cube.y()) & mask) << 21 | (std::uint64_t(cube.x()) & mask);
  }

  const std::vector<Eigen::Vector3f>* points_;
  Eigen::Vector3f low_;
  float edge_m_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted_;
};

struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();   // zero: a surface that is no plane
  float roughness_m = 0;
};

/// None: too few neighbours, or all on a line.
std::optional<Plane> plane_at(const Eigen::Vector3f& p, const Cubes& cubes) {
  int count = 0;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  cubes.for_each_within(p, [&](const Eigen::Vector3f& q) {
    const Eigen::Vector3f d = q - p;
    ++count;
    sum += d;
    squares += d * d.transpose();
  });
  if (count < least_neighbours) return std::nullopt;
  const Eigen::Vector3f mean = sum / float(count);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(squares / float(count) - mean * mean.transpose());
  const Eigen::Vector3f l = solver.eigenvalues().cwiseMax(0.0f);
  if (!(l[1] > breadth * l[2])) return std::nullopt;
  if (!(l[0] < flatness * l[1])) return Plane{};
  return Plane{solver.eigenvectors().col(0), std::sqrt(l[0])};
}

/// Up; those of walls to one half of the horizon, such that neighbours on a wall agree whatever their noise.
Eigen::Vector3f turned_up(const Eigen::Vector3f& normal) {
  constexpr float of_wall = 0.3f;
  const bool upwards = std::abs(normal.z()) > of_wall ? normal.z() > 0 : normal.x() + 0.37f * normal.y() > 0;
  return upwards ? normal : -normal;
}

}  // namespace

void estimate_normals(PointCloud& points) {
  points.normal.resize(points.size(), Eigen::Vector3f::Zero());
  std::vector<std::uint32_t> open;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (points.normal[i].isZero(0) && points.xyz[i].allFinite()) open.push_back(i);
  if (open.empty()) return;
  points.sigma_m.resize(points.size(), 0.0f);
  const std::vector<std::uint32_t> members = open;
  Eigen::Vector3f low = points.xyz[members.front()];
  for (const std::uint32_t i : members) low = low.cwiseMin(points.xyz[i]);
  for (const float radius_m : radii_m) {
    const Cubes cubes(points.xyz, members, low, radius_m);
    std::erase_if(open, [&](std::uint32_t i) {
      const std::optional<Plane> plane = plane_at(points.xyz[i], cubes);
      if (!plane) return false;
      points.normal[i] = turned_up(plane->normal);
      points.sigma_m[i] = std::hypot(std::isfinite(points.sigma_m[i]) ? points.sigma_m[i] : 0.0f, plane->roughness_m);
      return true;
    });
  }
}

}  // namespace priormap
