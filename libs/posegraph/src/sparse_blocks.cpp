#include "sparse_blocks.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace priormap {
namespace {

using Neighbours = std::vector<std::vector<std::uint32_t>>;

void sort_and_unite(std::vector<std::uint32_t>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Each pair in both of its rows, once.
void make_mutual(Neighbours& neighbours) {
  Neighbours from(neighbours.size());
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    for (const std::uint32_t j : neighbours[i]) from[j].push_back(std::uint32_t(i));
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    neighbours[i].insert(neighbours[i].end(), from[i].begin(), from[i].end());
    std::erase(neighbours[i], std::uint32_t(i));
    sort_and_unite(neighbours[i]);
  }
}

/// Rows in the order of their elimination.
std::vector<std::uint32_t> elimination_order(const Neighbours& neighbours) {
  const auto size = Eigen::Index(neighbours.size());
  Eigen::SparseMatrix<char> pattern(size, size);
  std::vector<Eigen::Triplet<char>> entries;
  for (Eigen::Index i = 0; i < size; ++i) {
    entries.emplace_back(i, i, char(1));
    for (const std::uint32_t j : neighbours[std::size_t(i)]) entries.emplace_back(i, Eigen::Index(j), char(1));
  }
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  return {order.indices().begin(), order.indices().end()};
}

}  // namespace

SparseBlocks::SparseBlocks(Neighbours neighbours) : rank_(neighbours.size()), columns_(neighbours.size()) {
  make_mutual(neighbours);
  const std::vector<std::uint32_t> order = elimination_order(neighbours);
  for (std::size_t r = 0; r < order.size(); ++r) rank_[order[r]] = std::uint32_t(r);
  Neighbours children(size());   // in the elimination tree: what they have in common with later rows, their parent has too
  for (std::uint32_t r = 0; r < size(); ++r) {
    std::vector<std::uint32_t>& rows = columns_[r].rows;
    for (const std::uint32_t j : neighbours[order[r]])
      if (rank_[j] > r) rows.push_back(rank_[j]);
    for (const std::uint32_t child : children[r]) rows.insert(rows.end(), columns_[child].rows.begin() + 1, columns_[child].rows.end());
    sort_and_unite(rows);
    if (!rows.empty()) children[rows.front()].push_back(r);
    columns_[r].blocks.assign(rows.size(), Matrix6d::Zero());
  }
}

void SparseBlocks::add(std::size_t i, std::size_t j, const Matrix6d& block) {
  const std::uint32_t row = std::max(rank_[i], rank_[j]);
  Column& column = columns_[std::min(rank_[i], rank_[j])];
  if (i == j) {
    column.diagonal += block;
    return;
  }
  Matrix6d& sum = column.blocks[std::size_t(std::lower_bound(column.rows.begin(), column.rows.end(), row) - column.rows.begin())];
  if (row == rank_[i])
    sum += block;
  else
    sum += block.transpose();
}

Matrix6d SparseBlocks::at(std::size_t i, std::size_t j) const {
  const std::uint32_t row = std::max(rank_[i], rank_[j]);
  const Column& column = columns_[std::min(rank_[i], rank_[j])];
  if (i == j) return column.diagonal;
  const auto found = std::lower_bound(column.rows.begin(), column.rows.end(), row);
  if (found == column.rows.end() || *found != row) return Matrix6d::Zero();
  const Matrix6d& block = column.blocks[std::size_t(found - column.rows.begin())];
  return row == rank_[i] ? block : Matrix6d(block.transpose());
}

}  // namespace priormap
