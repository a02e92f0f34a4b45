#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include <priormap/posegraph/pose_graph.hpp>

#include "block_cholesky.hpp"

namespace priormap {

/// The normal matrix of a pose graph. Each piece is tied to poses alone, so that all pieces are eliminated first, one by one (Schur complement); what is left are blocks of six rows.
class NormalMatrix {
 public:
  NormalMatrix(const std::vector<char>& held, std::size_t num_pieces);

  /// What falls on held poses is dropped.
  void add_pose(PoseId pose, const Matrix6d& block);
  /// What ties pose a to another pose b: the block (a, b), whose transpose is (b, a).
  void add_tie(PoseId a, PoseId b, const Matrix6d& block);
  /// What is known of the offset of a piece beforehand, axis by axis.
  void add_piece(PieceId piece, const Eigen::Vector3d& information);
  /// @param J  of the tangent of the equations with respect to that of the pose
  void add_sight(PoseId pose, PieceId piece, const PieceEquations& equations, const Matrix6d& J);

  /// Covariances of all poses (zero: held) and of the offsets of all pieces. @throws Error where the matrix is not positive definite
  Marginals marginals() const;

 private:
  using Matrix36d = Eigen::Matrix<double, 3, 6>;
  static constexpr std::uint32_t held = ~std::uint32_t(0);
  struct Tie {
    std::uint32_t a, b;
    Matrix6d block;
  };
  struct Sight {
    std::uint32_t pose;
    Matrix36d block;
  };
  struct PieceRows {
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    std::vector<Sight> seen;
  };
  /// Of the pieces, were all poses known.
  std::vector<Eigen::Matrix3d> covariances_of_pieces() const;
  SparseBlocks without_pieces(const std::vector<Eigen::Matrix3d>& covariances_of_pieces) const;
  std::vector<std::vector<std::uint32_t>> neighbours() const;

  std::vector<std::uint32_t> row_of_pose_;
  std::vector<Matrix6d> poses_;   // those that are not held
  std::vector<Tie> ties_;
  std::vector<PieceRows> pieces_;
};

}  // namespace priormap
