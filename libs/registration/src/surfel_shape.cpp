#include "surfel_shape.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <priormap/core/symmetric.hpp>

namespace priormap {
namespace {

/// Less wide than this (standard deviation) is the trace of one laser with its noise. It lies in the laser's cone, which travels with the sensor.
float least_width_m(float voxel_m) { return std::min(0.08f, 0.2f * voxel_m); }

SurfelShape shape_wider_than(float narrow_m, const Surfel& surfel, float voxel_m) {
  constexpr float least_points = 6, flatness = 0.1f, upright = 0.9f;
  const float thin = 0.15f * voxel_m;
  SurfelShape shape;
  if (surfel.count < least_points) return shape;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(full_of(surfel.covariance));
  const Eigen::Vector3f l = solver.eigenvalues().cwiseMax(0.0f);
  if (l[0] < flatness * l[1] && l[0] < thin * thin && l[1] > narrow_m * narrow_m) {
    shape.normal = solver.eigenvectors().col(0);
    shape.directed = 1;
    shape.sigma_m = std::sqrt(l[0]);
  } else if (l[1] < flatness * l[2] && l[1] < thin * thin && std::abs(solver.eigenvectors()(2, 2)) > upright) {
    // A pole or trunk. A line that lies flat is the trace of one laser on the ground: it travels with the sensor and binds nothing.
    shape.normal = solver.eigenvectors().col(2);
    shape.isotropic = 1;
    shape.directed = -1;
    shape.sigma_m = std::sqrt(l[1]);
  }
  return shape;
}

Eigen::Vector3f plane_normal(const SurfelShape& shape) { return shape.isotropic == 0 && shape.directed > 0 ? shape.normal : Eigen::Vector3f::Zero(); }

}  // namespace

bool is_wide(const Surfel& surfel, float voxel_m) {
  const auto& c = surfel.covariance;   // xx, xy, xz, yy, yz, zz
  const float trace = c[0] + c[3] + c[5], minors = c[0] * c[3] - c[1] * c[1] + c[0] * c[5] - c[2] * c[2] + c[3] * c[5] - c[4] * c[4];
  const float least_m = least_width_m(voxel_m);
  return minors > least_m * least_m * trace;   // of a plane: width^2 length^2 > least^2 (width^2 + length^2)
}

bool is_one_column(const Surfel& surfel) {
  constexpr float least_width_m = 0.02f;
  const float x = surfel.mean.x(), y = surfel.mean.y();
  const auto& c = surfel.covariance;   // xx, xy, xz, yy, yz, zz
  return c[0] * y * y - 2 * c[1] * x * y + c[3] * x * x < least_width_m * least_width_m * (x * x + y * y);
}

SurfelShape shape_of_moments(const Surfel& surfel, float voxel_m) { return shape_wider_than(least_width_m(voxel_m), surfel, voxel_m); }

SurfelShape shape_around(const Surfel& all, float voxel_m) {
  constexpr float least_width = 0.25f;   // voxels: of two traces at least
  return shape_wider_than(least_width * voxel_m, all, voxel_m);
}

Eigen::Vector3f cone_normal(const Eigen::Vector3f& p) {
  const Eigen::Vector3f across = Eigen::Vector3f::UnitZ() * p.squaredNorm() - p.z() * p;
  return across.isZero(0) ? across : across.normalized();
}

Eigen::Vector3f normal_of(const Surfel& surfel, double voxel_m) { return plane_normal(shape_of_moments(surfel, float(voxel_m))); }

void tell_normals(SurfelCloud& scan, double voxel_m) {
  scan.normals.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const SurfelShape own = shape_of_moments(scan.surfels[i], float(voxel_m));
    scan.normals[i] = plane_normal(own.tells_nothing() && !scan.around.empty() ? scan.around[i] : own);
  }
  std::vector<SurfelShape>().swap(scan.around);
}

}  // namespace priormap
