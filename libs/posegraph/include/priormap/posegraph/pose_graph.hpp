#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <priormap/core/se3.hpp>
#include <span>
#include <vector>

namespace priormap {

using PoseId = std::size_t;

struct PoseGraphOptions {
  double absolute_width = 1.0;
  double between_width = 1.0;
  int max_iterations = 50;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("absolute-width", absolute_width, {"width of the Tukey kernel on absolute constraints, in standard deviations; 0: no kernel", "", 0, 1e9});
    visit("between-width", between_width, {"width of the Cauchy kernel on relative constraints, in standard deviations; 0: no kernel", "", 0, 1e9});
    visit("graph-iterations", max_iterations, {"most iterations of the pose graph", "", 1, 10000});
  }
};

/// T_map_sensor as measured. `information` as in RegistrationResult: tangent [rotation, translation] in sensor axes.
struct AbsoluteFactor {
  PoseId id;
  Eigen::Isometry3d T_map_sensor;
  Matrix6d information;
};

/// T_a_b as measured, the pose of b in the frame of a; `information` in the axes of b.
struct BetweenFactor {
  PoseId a, b;
  Eigen::Isometry3d T_a_b;
  Matrix6d information;
};

struct OptimizeSummary {
  bool converged = false;
  int iterations = 0;
  double initial_cost = 0;
  double final_cost = 0;
};

/// Poses T_map_sensor tied by absolute and between factors. Residuals, in the tangent of `local_coordinates` and whitened by the
/// transposed Cholesky factor L^T of the information L L^T:
///   absolute: local_coordinates(measured, T)          robust: Tukey  (the paper, section III-D)
///   between:  local_coordinates(measured, T_a^-1 T_b) robust: Cauchy
/// Each is one residual of six rows under its kernel. Poses are numbered from 0 in the order added. Throws UsageError for an unknown id, or an
/// information matrix that is not finite, symmetric and positive semi-definite.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphOptions& options = {});

  PoseId add_pose(const Eigen::Isometry3d& T_map_sensor);
  void add_absolute(PoseId id, const Eigen::Isometry3d& T_map_sensor, const Matrix6d& information);
  void add_between(PoseId a, PoseId b, const Eigen::Isometry3d& T_a_b, const Matrix6d& information);

  /// Frame by frame: optimises the last `window` poses over the factors that touch them, all earlier ones held.
  OptimizeSummary optimize_last(std::size_t window = 1);
  /// All poses over all factors. A part of the graph without any absolute factor has its first pose held.
  OptimizeSummary optimize();

  std::size_t size() const { return poses_.size(); }
  const Eigen::Isometry3d& pose(PoseId id) const { return poses_.at(id); }
  void set_pose(PoseId id, const Eigen::Isometry3d& T_map_sensor) { poses_.at(id) = T_map_sensor; }
  std::span<const AbsoluteFactor> absolute_factors() const { return absolute_; }
  std::span<const BetweenFactor> between_factors() const { return between_; }

  /// Weight in (0, 1] that the kernel gives each factor at the present poses (Tukey: 0 for an outlier).
  std::vector<double> absolute_weights() const;
  std::vector<double> between_weights() const;
  /// Marginal covariance of each pose (the 6x6 diagonal blocks of the inverse of the weighted normal matrix at the present poses), same tangent as the
  /// information; in time linear in the poses of a chain. The first pose of a part that no absolute factor of non-zero weight ties to the map is held and
  /// has zero covariance: the others of that part are uncertain relative to it. A direction that nothing constrains gets the variance 1e8.
  std::vector<Matrix6d> marginal_covariances() const;

 private:
  struct FactorsOfPose {
    std::vector<std::size_t> absolute, between;
  };

  PoseGraphOptions options_;
  std::vector<FactorsOfPose> factors_of_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<AbsoluteFactor> absolute_;
  std::vector<BetweenFactor> between_;
};

}  // namespace priormap
