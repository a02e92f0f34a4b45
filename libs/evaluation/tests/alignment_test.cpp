#include <priormap/evaluation/alignment.hpp>

#include <gtest/gtest.h>

#include "made_trajectories.hpp"
#include <priormap/core/error.hpp>

namespace priormap {
namespace {

const Eigen::Isometry3d T_known = Eigen::Translation3d(5, -7, 2) * Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized());

TEST(Alignment, OfTheFirstPoseLaysOnlyThatPoseExactly) {
  const Trajectory reference = made::winding(50);
  Trajectory estimate = reference;
  estimate.poses[30].translation().x() += 1;
  made::transform(estimate, T_known);
  apply_alignment(estimate, find_alignment(reference, estimate, Alignment::first));
  EXPECT_TRUE(estimate.poses[0].isApprox(reference.poses[0], 1e-12));
  EXPECT_NEAR((estimate.poses[30].translation() - reference.poses[30].translation()).norm(), 1, 1e-12);
}

TEST(Alignment, BySe3UndoesARigidMotionButNoScale) {
  const Trajectory reference = made::winding(50);
  Trajectory estimate = reference;
  made::transform(estimate, T_known, 1.25);
  const Similarity similarity = find_alignment(reference, estimate, Alignment::se3);
  EXPECT_EQ(similarity.scale, 1);
  EXPECT_TRUE((similarity.T_reference_estimate.linear() * T_known.linear()).isIdentity(1e-12));
}

TEST(Alignment, BySim3FindsTheScaleOfASimilarity) {
  const Trajectory reference = made::winding(50);
  Trajectory estimate = reference;
  made::transform(estimate, T_known, 1.25);
  const Similarity similarity = find_alignment(reference, estimate, Alignment::sim3);
  EXPECT_NEAR(similarity.scale, 1 / 1.25, 1e-12);
  apply_alignment(estimate, similarity);
  for (std::size_t i = 0; i < reference.size(); ++i) EXPECT_TRUE(estimate.poses[i].isApprox(reference.poses[i], 1e-9)) << i;
}

TEST(Alignment, ByLeastSquaresNeverMirrors) {
  const Trajectory reference = made::winding(50);
  Trajectory estimate = reference;
  for (auto& pose : estimate.poses) pose.translation().z() *= -1;
  const Similarity similarity = find_alignment(reference, estimate, Alignment::se3);
  EXPECT_NEAR(similarity.T_reference_estimate.linear().determinant(), 1, 1e-12);
}

TEST(Alignment, IsRefusedWhereItIsUndetermined) {
  EXPECT_THROW(find_alignment(made::winding(2), made::winding(2), Alignment::se3), FormatError);
  Trajectory standing;
  standing.poses.assign(10, made::pose(1, 2, 3));
  EXPECT_THROW(find_alignment(made::winding(10), standing, Alignment::sim3), FormatError);
}

}  // namespace
}  // namespace priormap
