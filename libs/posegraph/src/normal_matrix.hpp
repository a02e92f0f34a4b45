#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include <priormap/posegraph/pose_graph.hpp>

#include "sparse_blocks.hpp"

namespace priormap {

/// The normal matrix of a pose graph: six rows for each pose, three for each piece. A piece that few poses see is eliminated before them; one that thousands see, in many laps around it,
/// after them, else each two of them would become neighbours. SparseBlocks finds that order, for which pieces are filled up to six rows.
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
  static constexpr std::uint32_t held = ~std::uint32_t(0);
  struct Tie {
    std::uint32_t a, b;
    Matrix6d block;
  };
  struct Sight {
    std::uint32_t pose, piece;
    Eigen::Matrix<double, 3, 6> block;
  };
  SparseBlocks blocks() const;

  std::vector<std::uint32_t> row_of_pose_;
  std::vector<Matrix6d> poses_;            // those that are not held; the rows after them are of pieces
  std::vector<Eigen::Matrix3d> pieces_;
  std::vector<Tie> ties_;
  std::vector<Sight> sights_;
};

}  // namespace priormap
