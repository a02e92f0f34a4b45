#include <gtest/gtest.h>

#include "offset_votes.hpp"

namespace priormap {
namespace {

/// A house whose walls lie off by `offset`, seen on three sides, with `hedges` other things before each wall, anywhere within 2 m.
OffsetVotes seen(const Eigen::Vector3d& offset, int hedges) {
  OffsetVotes votes;
  for (const Eigen::Vector3d& normal : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-1, 0, 0)}) {
    for (int i = 0; i < 50; ++i) votes.add({{0, 0, 0}, normal, normal.dot(offset), 1e-4});
    for (int i = 0; i < hedges; ++i) votes.add({{0, 0, 0}, normal, -2 + 4 * (i + 0.5) / hedges, 1e-4});
  }
  return votes;
}

TEST(OffsetVotes, TheMostVoicesWinHoweverFarOff) {
  for (const Eigen::Vector3d& offset : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1.5, -0.75, 0), Eigen::Vector3d(-2, 1.75, 0)})
    EXPECT_LT((seen(offset, 40).likeliest() - offset).norm(), 0.01) << offset.transpose();
}

TEST(OffsetVotes, OneWallSaysNothingOfTheOtherDirection) {
  OffsetVotes votes;
  for (int i = 0; i < 50; ++i) votes.add({{0, 0, 0}, {1, 0, 0}, 1.0, 1e-4});
  EXPECT_LT((votes.likeliest() - Eigen::Vector3d(1, 0, 0)).norm(), 0.01);
}

TEST(OffsetVotes, NoVoicesNoOffset) { EXPECT_TRUE(OffsetVotes().likeliest().isZero()); }

}  // namespace
}  // namespace priormap
