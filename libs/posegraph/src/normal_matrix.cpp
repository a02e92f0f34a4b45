#include "normal_matrix.hpp"

#include <utility>

#include "selected_inverse.hpp"

namespace priormap {

NormalMatrix::NormalMatrix(const std::vector<char>& is_held, std::size_t num_pieces) : row_of_pose_(is_held.size(), held), num_pieces_(num_pieces) {
  for (std::size_t i = 0; i < is_held.size(); ++i)
    if (!is_held[i]) row_of_pose_[i] = std::exchange(pose_rows_, pose_rows_ + 6);
}

void NormalMatrix::add(PoseId i, PoseId j, const Matrix6d& block) {
  const Eigen::Index row = row_of_pose_[i], column = row_of_pose_[j];
  if (row == held || column == held || row < column) return;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < (i == j ? r + 1 : 6); ++c) entries_.emplace_back(row + r, column + c, block(r, c));
}

void NormalMatrix::add(PieceId piece, const Eigen::Vector3d& information) {
  for (int i = 0; i < 3; ++i) {
    entries_.emplace_back(row_of(piece) + i, row_of(piece) + i, information[i]);
    entries_.emplace_back(row_of(piece) + 3 + i, row_of(piece) + 3 + i, 1.0);
  }
}

void NormalMatrix::add(PoseId pose, PieceId piece, const PieceEquations& equations, const Matrix6d& J) {
  const Eigen::Matrix<double, 9, 9> H = equations.H.cast<double>();
  add(pose, pose, J.transpose() * H.topLeftCorner<6, 6>() * J);
  const Eigen::Matrix<double, 3, 6> across = H.bottomLeftCorner<3, 6>() * J;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 6 && row_of_pose_[pose] != held; ++c) entries_.emplace_back(row_of(piece) + r, row_of_pose_[pose] + c, across(r, c));
    for (int c = 0; c <= r; ++c) entries_.emplace_back(row_of(piece) + r, row_of(piece) + c, H(6 + r, 6 + c));
  }
}

Marginals NormalMatrix::marginals() const {
  Marginals marginals{std::vector<Matrix6d>(row_of_pose_.size(), Matrix6d::Zero()), {}};
  const Eigen::Index rows = row_of(num_pieces_);
  if (rows == 0) return marginals;
  Eigen::SparseMatrix<double> lower(rows, rows);
  lower.setFromTriplets(entries_.begin(), entries_.end());
  const std::vector<Matrix6d> blocks = diagonal_blocks_of_inverse(lower);
  for (std::size_t i = 0; i < row_of_pose_.size(); ++i)
    if (row_of_pose_[i] != held) marginals.poses[i] = blocks[std::size_t(row_of_pose_[i]) / 6];
  for (std::size_t p = 0; p < num_pieces_; ++p) marginals.pieces.push_back(blocks[std::size_t(row_of(p)) / 6].topLeftCorner<3, 3>());
  return marginals;
}

}  // namespace priormap
