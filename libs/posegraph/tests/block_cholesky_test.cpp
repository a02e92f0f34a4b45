#include "block_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

using namespace priormap;

namespace {

Matrix6d random_block(std::mt19937& random) {
  std::normal_distribution<double> n;
  return Matrix6d::NullaryExpr([&] { return n(random); });
}

/// A chain with loops and a row tied to nothing, as sparse blocks and written out in full.
struct Example {
  static constexpr std::size_t size = 30;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ties;
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(6 * size, 6 * size);
  std::optional<SparseBlocks> sparse;

  explicit Example(double least_pivot) {
    std::mt19937 random(3);
    for (std::uint32_t i = 1; i + 1 < size; ++i) ties.emplace_back(i, i - 1);
    for (const auto& loop : {std::pair(2u, 17u), {25u, 5u}, {11u, 3u}, {3u, 11u}}) ties.push_back(loop);
    std::vector<std::vector<std::uint32_t>> neighbours(size);
    for (const auto& [i, j] : ties) neighbours[i].push_back(j);
    sparse.emplace(neighbours);
    for (const auto& [i, j] : ties) add(i, j, random_block(random));
    for (std::size_t i = 0; i < size; ++i) {
      const Matrix6d A = random_block(random);
      add(i, i, A * A.transpose() + (i == size / 2 ? least_pivot : 40) * Matrix6d::Identity());
    }
  }
  void add(std::size_t i, std::size_t j, const Matrix6d& block) {
    sparse->add(i, j, block);
    const auto r = Eigen::Index(6 * i), c = Eigen::Index(6 * j);
    full.block<6, 6>(r, c) += block;
    if (i != j) full.block<6, 6>(c, r) += block.transpose();
  }
  Matrix6d block(const Eigen::MatrixXd& m, std::size_t i, std::size_t j) const { return m.block<6, 6>(Eigen::Index(6 * i), Eigen::Index(6 * j)); }
};

TEST(BlockCholesky, ItsInverseIsThatOfTheFullMatrixOnTheDiagonalAndOnEachTie) {
  const Example example(40);
  const Eigen::MatrixXd expected = example.full.inverse();
  const SparseBlocks inverse = std::move(*BlockCholesky::of(*example.sparse)).inverse_on_pattern();
  const auto expect_block = [&](std::size_t i, std::size_t j) { EXPECT_LT((inverse.at(i, j) - example.block(expected, i, j)).norm(), 1e-12 * expected.norm()) << i << ' ' << j; };
  for (std::size_t i = 0; i < Example::size; ++i) expect_block(i, i);
  for (const auto& [i, j] : example.ties) expect_block(i, j), expect_block(j, i);
}

TEST(BlockCholesky, KeepsWhatWasAdded) {
  const Example example(40);
  for (std::size_t i = 0; i < Example::size; ++i)
    for (std::size_t j = 0; j < Example::size; ++j) EXPECT_EQ(example.sparse->at(i, j), example.block(example.full, i, j)) << i << ' ' << j;
}

TEST(BlockCholesky, FillsInLittleOfALongChain) {
  std::vector<std::vector<std::uint32_t>> neighbours(2000);
  for (std::uint32_t i = 1; i < neighbours.size(); ++i) neighbours[i] = {i - 1};
  const SparseBlocks chain(neighbours);
  std::size_t blocks = 0;
  for (const auto& column : chain.columns()) blocks += column.blocks.size();
  EXPECT_EQ(blocks, neighbours.size() - 1);   // eliminated from its ends, a chain fills in nothing
}

TEST(BlockCholesky, FillsInLittleOfManyLapsPastTheSameRows) {
  constexpr std::uint32_t laps = 20, per_lap = 100, num_seen = 50, in_sight = 10;   // as poses see pieces of the prior
  std::vector<std::vector<std::uint32_t>> neighbours(laps * per_lap + num_seen);
  std::size_t ties = 0;
  for (std::uint32_t i = 0; i < laps * per_lap; ++i) {
    if (i > 0) neighbours[i].push_back(i - 1);
    for (std::uint32_t s = 0; s < in_sight; ++s) neighbours[i].push_back(laps * per_lap + (i * num_seen / per_lap + s) % num_seen);
    ties += neighbours[i].size();
  }
  const SparseBlocks matrix(neighbours);
  std::size_t blocks = 0;
  for (const auto& column : matrix.columns()) blocks += column.blocks.size();
  EXPECT_LT(blocks, 3 * ties);   // were those rows eliminated first: 200 poses that see the same one, tied two by two
}

TEST(BlockCholesky, RefusesWhatIsNotPositiveDefinite) { EXPECT_FALSE(BlockCholesky::of(*Example(-500).sparse)); }

}  // namespace
