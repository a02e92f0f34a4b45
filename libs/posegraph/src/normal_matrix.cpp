#include "normal_matrix.hpp"

#include <optional>
#include <priormap/core/error.hpp>
#include <utility>

#include "block_cholesky.hpp"

namespace priormap {

NormalMatrix::NormalMatrix(const std::vector<char>& is_held, std::size_t num_pieces) : row_of_pose_(is_held.size(), held), pieces_(num_pieces, Eigen::Matrix3d::Zero()) {
  for (std::size_t i = 0; i < is_held.size(); ++i) {
    if (is_held[i]) continue;
    row_of_pose_[i] = std::uint32_t(poses_.size());
    poses_.push_back(Matrix6d::Zero());
  }
}

void NormalMatrix::add_pose(PoseId pose, const Matrix6d& block) {
  if (row_of_pose_[pose] != held) poses_[row_of_pose_[pose]] += block;
}

void NormalMatrix::add_tie(PoseId a, PoseId b, const Matrix6d& block) {
  if (row_of_pose_[a] != held && row_of_pose_[b] != held) ties_.push_back({row_of_pose_[a], row_of_pose_[b], block});
}

void NormalMatrix::add_piece(PieceId piece, const Eigen::Vector3d& information) { pieces_[piece].diagonal() += information; }

void NormalMatrix::add_sight(PoseId pose, PieceId piece, const PieceEquations& equations, const Matrix6d& J) {
  const Eigen::Matrix<double, 9, 9> H = equations.H.cast<double>();
  add_pose(pose, J.transpose() * H.topLeftCorner<6, 6>() * J);
  pieces_[piece] += H.bottomRightCorner<3, 3>();
  if (row_of_pose_[pose] != held) sights_.push_back({row_of_pose_[pose], std::uint32_t(poses_.size() + piece), H.bottomLeftCorner<3, 6>() * J});
}

SparseBlocks NormalMatrix::blocks() const {
  std::vector<std::vector<std::uint32_t>> neighbours(poses_.size() + pieces_.size());
  for (const Tie& tie : ties_) neighbours[tie.a].push_back(tie.b);
  for (const Sight& sight : sights_) neighbours[sight.pose].push_back(sight.piece);
  SparseBlocks blocks(std::move(neighbours));
  for (std::size_t i = 0; i < poses_.size(); ++i) blocks.add(i, i, poses_[i]);
  for (const Tie& tie : ties_) blocks.add(tie.a, tie.b, tie.block);
  Matrix6d filled_up = Matrix6d::Identity();
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    filled_up.topLeftCorner<3, 3>() = pieces_[p];
    blocks.add(poses_.size() + p, poses_.size() + p, filled_up);
  }
  filled_up.setZero();
  for (const Sight& sight : sights_) {
    filled_up.topRows<3>() = sight.block;
    blocks.add(sight.piece, sight.pose, filled_up);
  }
  return blocks;
}

Marginals NormalMatrix::marginals() const {
  std::optional<BlockCholesky> cholesky = BlockCholesky::of(blocks());
  if (!cholesky) throw Error("pose graph: its normal matrix cannot be factorised");
  const SparseBlocks covariances = std::move(*cholesky).inverse_on_pattern();
  Marginals marginals;
  for (const std::uint32_t row : row_of_pose_) marginals.poses.push_back(row == held ? Matrix6d::Zero() : covariances.at(row, row));
  for (std::size_t row = poses_.size(); row < covariances.size(); ++row) marginals.pieces.push_back(covariances.at(row, row).topLeftCorner<3, 3>());
  return marginals;
}

}  // namespace priormap
