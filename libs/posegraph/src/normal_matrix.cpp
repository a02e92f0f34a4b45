#include "normal_matrix.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>
#include <priormap/core/error.hpp>
#include <utility>

namespace priormap {
namespace {

[[noreturn]] void refuse() { throw Error("pose graph: its normal matrix cannot be factorised"); }

}  // namespace

NormalMatrix::NormalMatrix(const std::vector<char>& is_held, std::size_t num_pieces) : row_of_pose_(is_held.size(), held), pieces_(num_pieces) {
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

void NormalMatrix::add_piece(PieceId piece, const Eigen::Vector3d& information) { pieces_[piece].own.diagonal() += information; }

void NormalMatrix::add_sight(PoseId pose, PieceId piece, const PieceEquations& equations, const Matrix6d& J) {
  const Eigen::Matrix<double, 9, 9> H = equations.H.cast<double>();
  add_pose(pose, J.transpose() * H.topLeftCorner<6, 6>() * J);
  PieceRows& rows = pieces_[piece];
  rows.own += H.bottomRightCorner<3, 3>();
  const std::uint32_t row = row_of_pose_[pose];
  if (row == held) return;
  const Matrix36d across = H.bottomLeftCorner<3, 6>() * J;
  const auto before = std::find_if(rows.seen.rbegin(), rows.seen.rend(), [&](const Sight& sight) { return sight.pose == row; });
  if (before != rows.seen.rend())
    before->block += across;
  else
    rows.seen.push_back({row, across});
}

std::vector<std::vector<std::uint32_t>> NormalMatrix::neighbours() const {
  std::vector<std::vector<std::uint32_t>> neighbours(poses_.size());
  for (const Tie& tie : ties_) neighbours[tie.a].push_back(tie.b);
  for (const PieceRows& rows : pieces_)
    for (std::size_t n = 0; n < rows.seen.size(); ++n)
      for (std::size_t m = 0; m < n; ++m) neighbours[rows.seen[n].pose].push_back(rows.seen[m].pose);
  return neighbours;
}

std::vector<Eigen::Matrix3d> NormalMatrix::covariances_of_pieces() const {
  std::vector<Eigen::Matrix3d> covariances;
  covariances.reserve(pieces_.size());
  for (const PieceRows& rows : pieces_) {
    const Eigen::LLT<Eigen::Matrix3d> own(rows.own);
    if (own.info() != Eigen::Success) refuse();
    covariances.push_back(own.solve(Eigen::Matrix3d::Identity()));
  }
  return covariances;
}

SparseBlocks NormalMatrix::without_pieces(const std::vector<Eigen::Matrix3d>& covariances_of_pieces) const {
  SparseBlocks reduced(neighbours());
  for (std::size_t i = 0; i < poses_.size(); ++i) reduced.add(i, i, poses_[i]);
  for (const Tie& tie : ties_) reduced.add(tie.a, tie.b, tie.block);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const std::vector<Sight>& seen = pieces_[p].seen;
    for (std::size_t n = 0; n < seen.size(); ++n) {
      const Matrix36d solved = covariances_of_pieces[p] * seen[n].block;
      for (std::size_t m = 0; m <= n; ++m) reduced.add(seen[m].pose, seen[n].pose, -seen[m].block.transpose() * solved);
    }
  }
  return reduced;
}

Marginals NormalMatrix::marginals() const {
  Marginals marginals{std::vector<Matrix6d>(row_of_pose_.size(), Matrix6d::Zero()), covariances_of_pieces()};
  std::optional<BlockCholesky> cholesky = BlockCholesky::of(without_pieces(marginals.pieces));
  if (!cholesky) refuse();
  const SparseBlocks covariances = std::move(*cholesky).inverse_on_pattern();
  for (std::size_t i = 0; i < row_of_pose_.size(); ++i)
    if (row_of_pose_[i] != held) marginals.poses[i] = covariances.at(row_of_pose_[i], row_of_pose_[i]);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    // What is not known of the poses that see it adds to what is not known of the piece from there.
    Eigen::Matrix3d& covariance = marginals.pieces[p];
    std::vector<Sight> solved = pieces_[p].seen;
    for (Sight& sight : solved) sight.block = covariance * sight.block;
    for (const Sight& n : solved) {
      Matrix36d sum = Matrix36d::Zero();
      for (const Sight& m : solved) sum += m.block * covariances.at(m.pose, n.pose);
      covariance += sum * n.block.transpose();
    }
    covariance = (0.5 * (covariance + covariance.transpose())).eval();
  }
  return marginals;
}

}  // namespace priormap
