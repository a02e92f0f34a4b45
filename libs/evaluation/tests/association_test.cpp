#include <priormap/evaluation/association.hpp>

#include <gtest/gtest.h>

#include "made_trajectories.hpp"

namespace priormap {
namespace {

Trajectory at_times(std::vector<double> stamps_s) {
  Trajectory trajectory = made::winding(stamps_s.size());
  trajectory.stamps_s = std::move(stamps_s);
  return trajectory;
}

TEST(Associate, ByStampTakesTheNearestWithinTheLimitAndNoneTwice) {
  const auto pairs = associate(at_times({0.0, 0.1, 0.2, 0.3}), at_times({0.004, 0.098, 0.101, 0.15, 0.305}), 0.01);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].reference, 0u);
  EXPECT_EQ(pairs[0].estimate, 0u);
  EXPECT_EQ(pairs[1].reference, 1u);
  EXPECT_EQ(pairs[1].estimate, 2u) << "0.101 is nearer to 0.1 than 0.098";
  EXPECT_EQ(pairs[2].reference, 3u);
  EXPECT_EQ(pairs[2].estimate, 4u);
}

TEST(Associate, ByIndexGoesBeforeStamps) {
  Trajectory reference = at_times({0, 1, 2}), estimate = at_times({0, 1});
  reference.indices = {10, 11, 12};
  estimate.indices = {12, 10};
  const auto pairs = associate(reference, estimate, 0.01);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].reference, 2u);
  EXPECT_EQ(pairs[1].reference, 0u);
}

/// The mapper counts the scans that there are; the truth counts those that were lost as well.
TEST(Associate, IndicesThatCountPastMissingScansGiveWayToStamps) {
  Trajectory reference = at_times({0, 0.1, 0.2, 0.3, 0.4}), estimate = at_times({0, 0.1, 0.3, 0.4});
  reference.indices = {0, 1, 2, 3, 4};
  estimate.indices = {0, 1, 2, 3};
  const auto pairs = associate(reference, estimate, 0.01);
  ASSERT_EQ(pairs.size(), 4u);
  EXPECT_EQ(pairs[2].reference, 3u);
  EXPECT_EQ(pairs[3].reference, 4u);
}

TEST(Associate, ClocksThatJitterDoNotOutvoteIndices) {
  Trajectory reference = at_times({0, 0.1, 0.2, 0.3}), estimate = at_times({0, 0.13, 0.22, 0.3});
  reference.indices = estimate.indices = {0, 1, 2, 3};
  EXPECT_EQ(associate(reference, estimate, 0.01).size(), 4u);
}

TEST(Associate, WithNothingInCommonGoesLineByLine) { EXPECT_EQ(associate(made::winding(5), at_times({7, 8, 9}), 0.01).size(), 3u); }

}  // namespace
}  // namespace priormap
