#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <priormap/core/se3.hpp>
#include <priormap/core/state_archive.hpp>
#include <span>
#include <vector>

namespace priormap {

using PoseId = std::size_t;
using PieceId = std::size_t;

struct PoseGraphOptions {
  double absolute_width = 1.0;
  double between_width = 1.0;
  double piece_width = 2.0;
  int max_iterations = 50;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("absolute-width", absolute_width, {"width of the Tukey kernel on absolute constraints, in standard deviations; 0: no kernel", "", 0, 1e9});
    visit("between-width", between_width, {"width of the Cauchy kernel on relative constraints, in standard deviations; 0: no kernel", "", 0, 1e9});
    visit("piece-width", piece_width, {"width of the Cauchy kernel on the offsets of pieces of the prior, in standard deviations; 0: no kernel", "", 0, 1e9});
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

/// Normal equations of a quadratic cost 1/2 z^T H z + g^T z in z = [tangent of the pose at the place of linearisation (retract), offset of a piece of the prior in map axes].
/// float32: there is one for each scan and piece in its sight.
struct PieceEquations {
  Eigen::Matrix<float, 9, 9> H = Eigen::Matrix<float, 9, 9>::Zero();
  Eigen::Matrix<float, 9, 1> g = Eigen::Matrix<float, 9, 1>::Zero();
};

/// What a scan taken at about `T_map_sensor` says about its pose and the offset of a piece.
struct PieceFactor {
  PoseId pose;
  PieceId piece;
  Eigen::Isometry3d T_map_sensor;
  PieceEquations equations;
};

/// A piece of the prior that may lie off as a whole.
struct Piece {
  Eigen::Vector3d sigma_m;                               ///< a priori, of its offset in map axes
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();    ///< estimated
};

struct OptimizeSummary {
  bool converged = false;
  int iterations = 0;
  double initial_cost = 0;
  double final_cost = 0;
};

/// Covariances of each pose (tangent as the information) and of the offset of each piece (map axes).
struct Marginals {
  std::vector<Matrix6d> poses;
  std::vector<Eigen::Matrix3d> pieces;
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
  /// Pieces are only estimated by `optimize`, their offsets under a Cauchy kernel.
  PieceId add_piece(const Eigen::Vector3d& sigma_m);
  void add_piece_factor(PoseId pose, PieceId piece, const Eigen::Isometry3d& T_map_sensor, const PieceEquations& equations);

  /// Frame by frame: optimises the last `window` poses over the factors that touch them, all earlier ones held.
  OptimizeSummary optimize_last(std::size_t window = 1);
  /// All poses over all factors, until a step lowers the cost by less than a share `least_gain` of it. A part of the graph without any absolute factor has its first pose held.
  OptimizeSummary optimize(double least_gain = 1e-9);

  /// Poses, factors and pieces, for a graph made with the same options.
  void exchange(StateArchive& archive);

  std::size_t size() const { return poses_.size(); }
  const Eigen::Isometry3d& pose(PoseId id) const { return poses_.at(id); }
  std::span<const Piece> pieces() const { return pieces_; }

  /// Weight in (0, 1] that the kernel gives each factor at the present poses (Tukey: 0 for an outlier).
  std::vector<double> absolute_weights() const;
  std::vector<double> between_weights() const;
  std::vector<double> piece_weights() const;
  /// Marginal covariances (the 6x6 diagonal blocks of the inverse of the weighted normal matrix at the present poses), same tangent as the
  /// information; in time linear in the poses of a chain. The first pose of a part that no absolute factor of non-zero weight ties to the map is held and
  /// has zero covariance: the others of that part are uncertain relative to it. A direction that nothing constrains gets the variance 1e8.
  Marginals marginals() const;
  std::vector<Matrix6d> marginal_covariances() const { return marginals().poses; }

 private:
  struct FactorsOfPose {
    std::vector<std::size_t> absolute, between;
  };
  /// The first of each part that nothing ties to the map.
  std::vector<char> poses_without_anchor(const std::vector<double>& absolute_weights) const;

  PoseGraphOptions options_;
  std::vector<FactorsOfPose> factors_of_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<AbsoluteFactor> absolute_;
  std::vector<BetweenFactor> between_;
  std::vector<Piece> pieces_;
  std::vector<PieceFactor> piece_factors_;
};

}  // namespace priormap
