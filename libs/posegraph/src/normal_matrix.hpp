#pragma once
#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

#include <priormap/posegraph/pose_graph.hpp>

namespace priormap {

/// The lower triangle of the normal matrix of a pose graph, block by block: six rows for each pose that is not held, then six for each piece, of which its offset takes
/// three (the others are ones on the diagonal: the inverse is taken by blocks of six).
class NormalMatrix {
 public:
  NormalMatrix(const std::vector<char>& held, std::size_t num_pieces);

  /// What ties pose i to pose j, and, given a second time, j to i; what falls on held poses or above the diagonal is dropped.
  void add(PoseId i, PoseId j, const Matrix6d& block);
  /// What is known of the offset of a piece beforehand, axis by axis.
  void add(PieceId piece, const Eigen::Vector3d& information);
  /// @param J  of the tangent of the equations with respect to that of the pose
  void add(PoseId pose, PieceId piece, const PieceEquations& equations, const Matrix6d& J);

  /// Covariances of all poses (zero: held) and of the offsets of all pieces.
  Marginals marginals() const;

 private:
  static constexpr Eigen::Index held = -1;
  Eigen::Index row_of(PieceId piece) const { return pose_rows_ + Eigen::Index(6 * piece); }

  std::vector<Eigen::Index> row_of_pose_;
  std::size_t num_pieces_;
  Eigen::Index pose_rows_ = 0;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace priormap
