#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <numeric>
#include <utility>
#include <priormap/core/error.hpp>
#include <priormap/posegraph/pose_graph.hpp>

#include "normal_matrix.hpp"
#include "pose_residuals.hpp"

namespace priormap {
namespace {

using PoseParameters = std::array<double, 7>;  // qx qy qz qw tx ty tz
using RowMatrix67 = Eigen::Matrix<double, 6, 7, Eigen::RowMajor>;
using RowMatrix76 = Eigen::Matrix<double, 7, 6, Eigen::RowMajor>;

Eigen::Isometry3d pose_of(const double* x) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Map<const Eigen::Quaterniond>(x).toRotationMatrix();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(x + 4);
  return T;
}

void set_parameters(const Eigen::Isometry3d& T, double* x) {
  Eigen::Map<Eigen::Quaterniond>{x} = Eigen::Quaterniond(T.linear()).normalized();
  Eigen::Map<Eigen::Vector3d>{x + 4} = T.translation();
}

/// d(q exp(w), t + R v) / d(w, v) at zero.
RowMatrix76 plus_jacobian(const double* x) {
  const Eigen::Map<const Eigen::Quaterniond> q(x);
  RowMatrix76 J = RowMatrix76::Zero();
  J.topLeftCorner<3, 3>() = 0.5 * (q.w() * Eigen::Matrix3d::Identity() + hat(q.vec()));
  J.block<1, 3>(3, 0) = -0.5 * q.vec().transpose();
  J.bottomRightCorner<3, 3>() = q.toRotationMatrix();
  return J;
}

/// The left inverse of plus_jacobian: turns a Jacobian with respect to the tangent into one that Ceres takes.
RowMatrix67 minus_jacobian(const double* x) {
  const RowMatrix76 plus = plus_jacobian(x);
  RowMatrix67 J = RowMatrix67::Zero();
  J.topLeftCorner<3, 4>() = 4.0 * plus.topLeftCorner<4, 3>().transpose();
  J.bottomRightCorner<3, 3>() = plus.bottomRightCorner<3, 3>().transpose();
  return J;
}

class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    set_parameters(retract(pose_of(x), Eigen::Map<const Vector6d>(delta)), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<RowMatrix76>{jacobian} = plus_jacobian(x);
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Vector6d>{y_minus_x} = local_coordinates(pose_of(x), pose_of(y));
    return true;
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<RowMatrix67>{jacobian} = minus_jacobian(x);
    return true;
  }
};

/// U with U^T U = information, also where a direction is not observed at all.
Matrix6d square_root(const Matrix6d& information) {
  const Eigen::LDLT<Matrix6d> ldlt(information);
  Matrix6d U = ldlt.transpositionsP() * Matrix6d::Identity();
  U = ldlt.matrixU() * U;
  return ldlt.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal() * U;
}

class AbsoluteCost final : public ceres::SizedCostFunction<6, 7> {
 public:
  explicit AbsoluteCost(const AbsoluteFactor& factor) : measured_(factor.T_map_sensor), U_(square_root(factor.information)) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const AbsoluteResidual e = absolute_residual(measured_, pose_of(x[0]));
    Eigen::Map<Vector6d>{residuals} = U_ * e.r;
    if (jacobians && jacobians[0]) Eigen::Map<RowMatrix67>{jacobians[0]} = U_ * e.J * minus_jacobian(x[0]);
    return true;
  }

 private:
  Eigen::Isometry3d measured_;
  Matrix6d U_;
};

class BetweenCost final : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  explicit BetweenCost(const BetweenFactor& factor) : measured_(factor.T_a_b), U_(square_root(factor.information)) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const BetweenResidual e = between_residual(measured_, pose_of(x[0]), pose_of(x[1]));
    Eigen::Map<Vector6d>{residuals} = U_ * e.r;
    if (jacobians && jacobians[0]) Eigen::Map<RowMatrix67>{jacobians[0]} = U_ * e.J_a * minus_jacobian(x[0]);
    if (jacobians && jacobians[1]) Eigen::Map<RowMatrix67>{jacobians[1]} = U_ * e.J_b * minus_jacobian(x[1]);
    return true;
  }

 private:
  Eigen::Isometry3d measured_;
  Matrix6d U_;
};

class PieceCost final : public ceres::SizedCostFunction<9, 7, 3> {
 public:
  explicit PieceCost(const PieceFactor& factor) : linearised_(factor.T_map_sensor) {
    const Eigen::Matrix<double, 9, 9> H = factor.equations.H.cast<double>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(H);
    const Vector9d values = eigen.eigenvalues().cwiseMax(0.0);
    const double least = 1e-6 * values.maxCoeff();  // below: noise of float32
    const Vector9d root = (values.array() > least).select(values.cwiseSqrt(), 0.0);
    const Vector9d inverse_root = (root.array() > 0).select(root.cwiseInverse(), 0.0);
    U_ = root.asDiagonal() * eigen.eigenvectors().transpose();
    u_ = inverse_root.asDiagonal() * (eigen.eigenvectors().transpose() * factor.equations.g.cast<double>());
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const AbsoluteResidual e = absolute_residual(linearised_, pose_of(x[0]));
    Vector9d z;
    z << e.r, Eigen::Map<const Eigen::Vector3d>(x[1]);
    Eigen::Map<Vector9d>{residuals} = U_ * z + u_;
    if (jacobians && jacobians[0]) Eigen::Map<Eigen::Matrix<double, 9, 7, Eigen::RowMajor>>{jacobians[0]} = U_.leftCols<6>() * e.J * minus_jacobian(x[0]);
    if (jacobians && jacobians[1]) Eigen::Map<Eigen::Matrix<double, 9, 3, Eigen::RowMajor>>{jacobians[1]} = U_.rightCols<3>();
    return true;
  }

 private:
  Eigen::Isometry3d linearised_;
  Eigen::Matrix<double, 9, 9> U_;
  Vector9d u_;
};

class OffsetCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  explicit OffsetCost(const Eigen::Vector3d& sigma_m) : per_sigma_(sigma_m.cwiseInverse()) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::Vector3d>{residuals} = per_sigma_.cwiseProduct(Eigen::Map<const Eigen::Vector3d>(x[0]));
    if (jacobians && jacobians[0]) Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[0]} = per_sigma_.asDiagonal();
    return true;
  }

 private:
  Eigen::Vector3d per_sigma_;
};

/// The Ceres problem over some of the poses. One thread and Eigen's own sparse solver: Ceres sums per thread and BLAS blocks per machine, and then the last bits vary.
class PoseProblem {
 public:
  PoseProblem(std::span<const Eigen::Isometry3d> poses, const PoseGraphOptions& options)
      : options_(options), tukey_(options.absolute_width > 0 ? options.absolute_width : 1.0),
        cauchy_(options.between_width > 0 ? options.between_width : 1.0), piece_cauchy_(options.piece_width > 0 ? options.piece_width : 1.0),
        parameters_(poses.size()), problem_(not_owning()) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      set_parameters(poses[i], parameters_[i].data());
      problem_.AddParameterBlock(parameters_[i].data(), 7, &manifold_);
    }
  }

  void hold(std::size_t i) { problem_.SetParameterBlockConstant(parameters_[i].data()); }
  void add(const AbsoluteFactor& factor, std::size_t i) {
    problem_.AddResidualBlock(new AbsoluteCost(factor), options_.absolute_width > 0 ? &tukey_ : nullptr, parameters_[i].data());
  }
  void add(const BetweenFactor& factor, std::size_t a, std::size_t b) {
    problem_.AddResidualBlock(new BetweenCost(factor), options_.between_width > 0 ? &cauchy_ : nullptr, parameters_[a].data(),
                              parameters_[b].data());
  }

  void add(std::span<const Piece> pieces) {
    for (const Piece& piece : pieces) offsets_.push_back(piece.offset_m);
    for (std::size_t p = 0; p < pieces.size(); ++p)
      problem_.AddResidualBlock(new OffsetCost(pieces[p].sigma_m), options_.piece_width > 0 ? &piece_cauchy_ : nullptr, offsets_[p].data());
  }
  void add(const PieceFactor& factor) {
    problem_.AddResidualBlock(new PieceCost(factor), nullptr, parameters_[factor.pose].data(), offsets_[factor.piece].data());
  }
  const Eigen::Vector3d& offset(std::size_t i) const { return offsets_[i]; }

  OptimizeSummary solve(bool sparse, double least_gain) {
    ceres::Solver::Options options;
    options.linear_solver_type = sparse ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::DENSE_NORMAL_CHOLESKY;
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    options.max_num_iterations = options_.max_iterations;
    options.function_tolerance = least_gain;
    options.parameter_tolerance = 1e-14;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return {summary.termination_type == ceres::CONVERGENCE, int(summary.iterations.size()), summary.initial_cost, summary.final_cost};
  }

  Eigen::Isometry3d pose(std::size_t i) const { return pose_of(parameters_[i].data()); }

 private:
  static ceres::Problem::Options not_owning() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.disable_all_safety_checks = true;
    return options;
  }

  PoseGraphOptions options_;
  ceres::TukeyLoss tukey_;
  ceres::CauchyLoss cauchy_, piece_cauchy_;
  PoseManifold manifold_;
  std::vector<PoseParameters> parameters_;
  std::vector<Eigen::Vector3d> offsets_;
  ceres::Problem problem_;
};

void check_information(const Matrix6d& information) {
  const double scale = information.cwiseAbs().maxCoeff();
  const bool symmetric = information.allFinite() && (information - information.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale;
  if (!symmetric || Eigen::SelfAdjointEigenSolver<Matrix6d>(information, Eigen::EigenvaluesOnly).eigenvalues()[0] < -1e-9 * scale)
    throw UsageError("pose graph: an information matrix must be finite, symmetric and positive semi-definite");
}

/// Poses that fix the gauge: the first of each connected part in which no pose is `anchored`.
std::vector<char> held_poses(const std::vector<char>& anchored, std::span<const BetweenFactor> between) {
  std::vector<std::size_t> first(anchored.size());
  std::iota(first.begin(), first.end(), std::size_t(0));
  const auto root = [&](std::size_t i) {
    while (first[i] != i) i = first[i] = first[first[i]];
    return i;
  };
  for (const auto& factor : between) {
    const std::size_t a = root(factor.a), b = root(factor.b);
    first[std::max(a, b)] = std::min(a, b);
  }
  std::vector<char> part_anchored(anchored.size(), 0), held(anchored.size(), 0);
  for (std::size_t i = 0; i < anchored.size(); ++i)
    if (anchored[i]) part_anchored[root(i)] = 1;
  for (std::size_t i = 0; i < anchored.size(); ++i) held[i] = root(i) == i && !part_anchored[i];
  return held;
}

}  // namespace

PoseGraph::PoseGraph(const PoseGraphOptions& options) : options_(options) {}

PoseId PoseGraph::add_pose(const Eigen::Isometry3d& T_map_sensor) {
  poses_.push_back(T_map_sensor);
  factors_of_.emplace_back();
  return poses_.size() - 1;
}

void PoseGraph::add_absolute(PoseId id, const Eigen::Isometry3d& T_map_sensor, const Matrix6d& information) {
  if (id >= size()) throw UsageError("pose graph: an absolute factor on a pose that does not exist");
  check_information(information);
  factors_of_[id].absolute.push_back(absolute_.size());
  absolute_.push_back({id, T_map_sensor, information});
}

void PoseGraph::add_between(PoseId a, PoseId b, const Eigen::Isometry3d& T_a_b, const Matrix6d& information) {
  if (a >= size() || b >= size() || a == b) throw UsageError("pose graph: a between factor needs two poses that exist");
  check_information(information);
  factors_of_[std::max(a, b)].between.push_back(between_.size());
  between_.push_back({a, b, T_a_b, information});
}

PieceId PoseGraph::add_piece(const Eigen::Vector3d& sigma_m) {
  if (!(sigma_m.minCoeff() > 0)) throw UsageError("pose graph: the sigma of a piece must be above 0");
  pieces_.push_back({sigma_m});
  return pieces_.size() - 1;
}

void PoseGraph::add_piece_factor(PoseId pose, PieceId piece, const Eigen::Isometry3d& T_map_sensor, const PieceEquations& equations) {
  if (pose >= size() || piece >= pieces_.size()) throw UsageError("pose graph: a factor on a pose or piece that does not exist");
  piece_factors_.push_back({pose, piece, T_map_sensor, equations});
}

void PoseGraph::exchange(StateArchive& archive) {
  archive(poses_, absolute_, between_, pieces_, piece_factors_);
  if (!archive.reading()) return;
  factors_of_.assign(poses_.size(), {});
  for (std::size_t f = 0; f < absolute_.size(); ++f) factors_of_.at(absolute_[f].id).absolute.push_back(f);
  for (std::size_t f = 0; f < between_.size(); ++f) factors_of_.at(std::max(between_[f].a, between_[f].b)).between.push_back(f);
}

OptimizeSummary PoseGraph::optimize_last(std::size_t window) {
  const std::size_t begin = size() - std::min(window, size());
  std::size_t oldest = begin;
  for (std::size_t i = begin; i < size(); ++i)
    for (const std::size_t f : factors_of_[i].between) oldest = std::min({oldest, between_[f].a, between_[f].b});

  PoseProblem problem(std::span<const Eigen::Isometry3d>(poses_).subspan(oldest), options_);
  for (std::size_t i = oldest; i < begin; ++i) problem.hold(i - oldest);
  for (std::size_t i = begin; i < size(); ++i) {
    for (const std::size_t f : factors_of_[i].absolute) problem.add(absolute_[f], i - oldest);
    for (const std::size_t f : factors_of_[i].between) problem.add(between_[f], between_[f].a - oldest, between_[f].b - oldest);
  }
  const OptimizeSummary summary = problem.solve(false, 1e-9);
  for (std::size_t i = begin; i < size(); ++i) poses_[i] = problem.pose(i - oldest);
  return summary;
}

OptimizeSummary PoseGraph::optimize(double least_gain) {
  std::vector<char> anchored(size());
  for (std::size_t i = 0; i < size(); ++i) anchored[i] = !factors_of_[i].absolute.empty();
  for (const auto& factor : piece_factors_) anchored[factor.pose] = 1;
  const std::vector<char> held = held_poses(anchored, between_);

  PoseProblem problem(poses_, options_);
  problem.add(pieces_);
  for (std::size_t i = 0; i < size(); ++i)
    if (held[i]) problem.hold(i);
  for (const auto& factor : absolute_) problem.add(factor, factor.id);
  for (const auto& factor : between_) problem.add(factor, factor.a, factor.b);
  for (const auto& factor : piece_factors_) problem.add(factor);
  const OptimizeSummary summary = problem.solve(true, least_gain);
  for (std::size_t i = 0; i < size(); ++i)
    if (!held[i]) poses_[i] = problem.pose(i);
  for (std::size_t p = 0; p < pieces_.size(); ++p) pieces_[p].offset_m = problem.offset(p);
  return summary;
}

std::vector<double> PoseGraph::absolute_weights() const {
  std::vector<double> weights;
  weights.reserve(absolute_.size());
  for (const auto& factor : absolute_) {
    const Vector6d r = local_coordinates(factor.T_map_sensor, poses_[factor.id]);
    weights.push_back(tukey_weight(r.dot(factor.information * r), options_.absolute_width));
  }
  return weights;
}

std::vector<double> PoseGraph::between_weights() const {
  std::vector<double> weights;
  weights.reserve(between_.size());
  for (const auto& factor : between_) {
    const Vector6d r = local_coordinates(factor.T_a_b, poses_[factor.a].inverse(Eigen::Isometry) * poses_[factor.b]);
    weights.push_back(cauchy_weight(r.dot(factor.information * r), options_.between_width));
  }
  return weights;
}

std::vector<double> PoseGraph::piece_weights() const {
  std::vector<double> weights;
  weights.reserve(pieces_.size());
  for (const Piece& piece : pieces_) weights.push_back(cauchy_weight(piece.offset_m.cwiseQuotient(piece.sigma_m).squaredNorm(), options_.piece_width));
  return weights;
}

std::vector<char> PoseGraph::poses_without_anchor(const std::vector<double>& absolute_weights) const {
  std::vector<char> anchored(size(), 0);
  for (std::size_t f = 0; f < absolute_.size(); ++f)
    if (absolute_weights[f] > 0) anchored[absolute_[f].id] = 1;
  for (const auto& factor : piece_factors_) anchored[factor.pose] = 1;
  return held_poses(anchored, between_);
}

Marginals PoseGraph::marginals() const {
  const std::vector<double> w_absolute = absolute_weights(), w_between = between_weights(), w_piece = piece_weights();
  constexpr double least = 1e-8;   // for directions that nothing constrains
  NormalMatrix normal(poses_without_anchor(w_absolute), pieces_.size());
  for (std::size_t i = 0; i < size(); ++i) normal.add_pose(i, least * Matrix6d::Identity());
  for (std::size_t f = 0; f < absolute_.size(); ++f) {
    const AbsoluteFactor& factor = absolute_[f];
    const Matrix6d J = absolute_residual(factor.T_map_sensor, poses_[factor.id]).J;
    normal.add_pose(factor.id, w_absolute[f] * J.transpose() * factor.information * J);
  }
  for (std::size_t f = 0; f < between_.size(); ++f) {
    const BetweenFactor& factor = between_[f];
    const BetweenResidual e = between_residual(factor.T_a_b, poses_[factor.a], poses_[factor.b]);
    const Matrix6d information = w_between[f] * factor.information;
    normal.add_pose(factor.a, e.J_a.transpose() * information * e.J_a);
    normal.add_pose(factor.b, e.J_b.transpose() * information * e.J_b);
    normal.add_tie(factor.a, factor.b, e.J_a.transpose() * information * e.J_b);
  }
  for (std::size_t p = 0; p < pieces_.size(); ++p) normal.add_piece(p, (w_piece[p] / pieces_[p].sigma_m.array().square()).matrix());
  for (const PieceFactor& factor : piece_factors_)
    normal.add_sight(factor.pose, factor.piece, factor.equations, absolute_residual(factor.T_map_sensor, poses_[factor.pose]).J);
  return normal.marginals();
}

}  // namespace priormap
