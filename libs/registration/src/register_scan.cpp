#include <Eigen/Cholesky>
#include <cmath>
#include <priormap/core/parallel.hpp>
#include <priormap/registration/register_scan.hpp>
#include <vector>

namespace priormap {
namespace {

constexpr std::size_t chunk_points = 128;  // sums run within chunks, then over chunks in order, whoever computed them

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();  // J^T W J
  Vector6d g = Vector6d::Zero();  // J^T W r
  std::size_t correspondences = 0;
  std::size_t inliers = 0;
  double inlier_squares = 0;

  void operator+=(const NormalEquations& other) {
    H += other.H;
    g += other.g;
    correspondences += other.correspondences;
    inliers += other.inliers;
    inlier_squares += other.inlier_squares;
  }
};

/// Adds the residual R^T (T p - q) in sensor axes; its Jacobian there is [-hat(p), I].
void add_point(const Eigen::Vector3d& p, const Eigen::Vector3d& r, double kernel_width, NormalEquations& sum) {
  const double squared = r.squaredNorm();
  const double k = kernel_width * kernel_width;
  const double root = k / (k + squared);
  const double w = root * root;  // Geman-McClure
  const Eigen::Matrix3d p_hat = hat(p);
  sum.H.topLeftCorner<3, 3>().noalias() -= w * p_hat * p_hat;
  sum.H.topRightCorner<3, 3>() += w * p_hat;
  sum.H.bottomRightCorner<3, 3>().diagonal().array() += w;
  sum.g.head<3>() += w * p.cross(r);
  sum.g.tail<3>() += w * r;
  ++sum.correspondences;
  if (squared < k) {
    ++sum.inliers;
    sum.inlier_squares += squared;
  }
}

NormalEquations linearize(const PointCloud& points, const VoxelHashMap& target, const Eigen::Isometry3d& T, const IcpOptions& options,
                          int threads) {
  std::vector<NormalEquations> chunks((points.size() + chunk_points - 1) / chunk_points);
  parallel_for(chunks.size(), threads, [&](std::size_t chunk) {
    const std::size_t end = std::min(points.size(), (chunk + 1) * chunk_points);
    for (std::size_t i = chunk * chunk_points; i < end; ++i) {
      const Eigen::Vector3d p = points.position(i);
      const Eigen::Vector3d p_target = T * p;
      const auto neighbor = target.nearest(p_target);
      if (!neighbor || neighbor->distance_m > options.max_distance_m) continue;
      add_point(p, T.linear().transpose() * (p_target - neighbor->position), options.kernel_width_m, chunks[chunk]);
    }
  });
  NormalEquations sum;
  for (const auto& chunk : chunks) sum += chunk;
  sum.H = Matrix6d(sum.H.selfadjointView<Eigen::Upper>());
  return sum;
}

bool is_solution(const Eigen::LDLT<Matrix6d>& solver, const Vector6d& step) {
  return solver.info() == Eigen::Success && solver.isPositive() && step.allFinite();
}

}  // namespace

RegistrationResult register_scan(const PointCloud& points, const VoxelHashMap& target, const Eigen::Isometry3d& T_target_source,
                                 const IcpOptions& options, int threads) {
  RegistrationResult result;
  result.T_target_source = T_target_source;
  NormalEquations system = linearize(points, target, T_target_source, options, threads);
  while (!result.converged && result.iterations < options.max_iterations && system.correspondences >= 3) {
    const Eigen::LDLT<Matrix6d> solver(system.H);
    const Vector6d step = -solver.solve(system.g);
    if (!is_solution(solver, step)) break;
    result.T_target_source = retract(result.T_target_source, step);
    result.converged = step.tail<3>().norm() < options.translation_epsilon_m && step.head<3>().norm() < options.rotation_epsilon_rad;
    ++result.iterations;
    system = linearize(points, target, result.T_target_source, options, threads);
  }
  result.num_correspondences = system.correspondences;
  result.num_inliers = system.inliers;
  result.inlier_rmse_m = system.inliers == 0 ? 0.0 : std::sqrt(system.inlier_squares / double(system.inliers));
  result.information = system.H;
  return result;
}

}  // namespace priormap
