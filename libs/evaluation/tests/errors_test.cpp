#include <gtest/gtest.h>

#include <numbers>

#include "made_trajectories.hpp"
#include <priormap/core/error.hpp>
#include <priormap/evaluation/evaluate.hpp>

namespace priormap {
namespace {

constexpr double deg = std::numbers::pi / 180;

TEST(AbsoluteError, OfAKnownOffsetIsThatOffset) {
  const Trajectory reference = made::winding(40);
  Trajectory estimate = reference;
  made::transform(estimate, made::pose(3, 4, -12));
  const AbsoluteError error = absolute_error(reference, estimate);
  EXPECT_NEAR(error.position_m.mean, 13, 1e-12);
  EXPECT_NEAR(error.position_m.max, 13, 1e-12);
  EXPECT_NEAR(error.horizontal_m.rmse, 5, 1e-12);
  EXPECT_NEAR(error.vertical_m.median, 12, 1e-12);
  EXPECT_NEAR(error.vertical_bias_m, -12, 1e-12);
  EXPECT_NEAR(error.rotation_rad.max, 0, 1e-12);
}

TEST(AbsoluteError, OfAPureRotationOfTheSensorIsOnlyRotation) {
  const Trajectory reference = made::winding(40);
  Trajectory estimate = reference;
  for (auto& pose : estimate.poses) pose.rotate(Eigen::AngleAxisd(7 * deg, Eigen::Vector3d(1, 2, 3).normalized()));
  const AbsoluteError error = absolute_error(reference, estimate);
  EXPECT_NEAR(error.position_m.max, 0, 1e-12);
  EXPECT_NEAR(error.rotation_rad.mean, 7 * deg, 1e-12);
}

TEST(RotationAngle, IsExactForTinyAndForHalfTurns) {
  for (const double angle : {0.0, 1e-9, 1e-3, 1.0, std::numbers::pi}) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    EXPECT_NEAR(rotation_angle(R), angle, 1e-15 + 1e-9 * angle);
  }
}

TEST(Statistics, OfFourValues) {
  const Statistics s = statistics({-1, 2, -3, 6});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.mean, 3);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(50.0 / 4));
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.max, 6);
  EXPECT_DOUBLE_EQ(statistics({5, 1, 2}).median, 2);
}

// A segment of L metres ends at the first pose farther than L: at 1 m spacing after L + 1 metres.
TEST(SegmentError, OfAScaledTrackIsTheScaleOverTheSegmentsAsKittiEndsThem) {
  const Trajectory reference = made::straight(1000, 1.0);
  const Trajectory estimate = made::straight(1000, 1.01);
  const SegmentError error = segment_error(reference, estimate);
  double sum = 0;
  std::size_t segments = 0;
  for (int length = 100; length <= 800; length += 100)
    for (int first = 0; first + length + 1 < 1000; first += 10, ++segments) sum += 0.01 * (length + 1) / length;
  EXPECT_EQ(error.segments, segments);
  EXPECT_NEAR(error.translation_ratio, sum / static_cast<double>(segments), 1e-12);
  EXPECT_NEAR(error.rotation_rad_per_m, 0, 1e-12);
  EXPECT_EQ(error.lengths_m, (std::vector<double>{100, 200, 300, 400, 500, 600, 700, 800}));
}

TEST(SegmentError, OfASteadyTurnIsItsRate) {
  const Trajectory reference = made::straight(301, 1.0);
  Trajectory estimate = reference;
  constexpr double rate_rad_per_m = 1e-4;
  for (std::size_t i = 0; i < estimate.size(); ++i)
    estimate.poses[i].linear() = Eigen::AngleAxisd(rate_rad_per_m * static_cast<double>(i), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const SegmentError error = segment_error(reference, estimate);
  EXPECT_NEAR(error.rotation_rad_per_m, rate_rad_per_m, 0.011 * rate_rad_per_m);
  EXPECT_EQ(error.lengths_m, (std::vector<double>{100, 200}));
}

TEST(SegmentError, OfAShortTrackTakesATenthOfTheLengths) {
  EXPECT_EQ(segment_error(made::straight(46, 1), made::straight(46, 1.1)).lengths_m, (std::vector<double>{10, 20, 30, 40}));
  EXPECT_EQ(segment_error(made::straight(46, 0.1), made::straight(46, 0.11)).lengths_m, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(segment_error(made::straight(2, 0.1), made::straight(2, 0.1)).segments, 0u);
}

TEST(SegmentError, DoesNotDependOnTheWorldFrameOfTheEstimate) {
  const Trajectory reference = made::winding(400);
  Trajectory estimate = reference;
  for (std::size_t i = 0; i < estimate.size(); ++i) estimate.poses[i].translation().x() += 1e-3 * static_cast<double>(i);
  const SegmentError before = segment_error(reference, estimate);
  made::transform(estimate, made::pose(1e3, -2e3, 50, 1.0));
  const SegmentError after = segment_error(reference, estimate);
  EXPECT_GT(before.translation_ratio, 1e-4);
  EXPECT_NEAR(after.translation_ratio, before.translation_ratio, 1e-9);
  EXPECT_NEAR(after.rotation_rad_per_m, before.rotation_rad_per_m, 1e-9);
}

// Poses 1 m apart, delta 3 m: stretches end at poses 3, 6, 9; pairs (3, 6) and (6, 9). The error sits between poses 4 and 5.
TEST(RelativeError, ChainsItsPairsAlongTheEstimateAndLeavesOutTheFirstPose) {
  const Trajectory reference = made::straight(11, 1.0);
  Trajectory estimate = reference;
  for (std::size_t i = 5; i < estimate.size(); ++i) estimate.poses[i].translation().z() += 0.5;
  const RelativeError error = relative_error(reference, estimate, 3.0);
  EXPECT_EQ(error.translation_m.count, 2u);
  EXPECT_DOUBLE_EQ(error.translation_m.max, 0.5);
  EXPECT_DOUBLE_EQ(error.translation_m.mean, 0.25);

  EXPECT_EQ(relative_error(reference, made::straight(11, 1.5), 3.0).translation_m.count, 4u) << "2 poses a stretch along the estimate";
  EXPECT_EQ(relative_error(reference, estimate, 30.0).translation_m.count, 0u);
}

TEST(EvaluateTrajectory, AlignsCountsAndWarns) {
  Trajectory reference = made::winding(60);
  Trajectory estimate = reference;
  made::transform(estimate, made::pose(100, 50, 3, 0.4));
  for (std::int64_t i = 0; i < 60; ++i) reference.indices.push_back(i), estimate.indices.push_back(i + 5);
  estimate.poses.erase(estimate.poses.begin(), estimate.poses.begin() + 5);
  estimate.indices.erase(estimate.indices.begin() + 55, estimate.indices.end());
  reference.indices.pop_back(), reference.poses.pop_back();
  std::string warning;
  Events events;
  events.warning = [&](const std::string& text) { warning = text; };
  EvaluationOptions options;
  options.align = Alignment::se3;
  const TrajectoryEvaluation evaluation = evaluate_trajectory(reference, estimate, options, events);
  EXPECT_EQ(evaluation.pairs, 54u);
  EXPECT_NE(warning.find("1 of 55"), std::string::npos) << warning;
  EXPECT_NEAR(evaluation.ate.position_m.max, 0, 1e-9);
}

TEST(EvaluateTrajectory, RefusesATrajectoryWithoutPoses) {
  const Trajectory reference = made::winding(60);
  EXPECT_THROW(evaluate_trajectory(reference, {}, {}, {}), FormatError);
  EXPECT_THROW(evaluate_trajectory({}, reference, {}, {}), FormatError);
}

TEST(EvaluateTrajectory, ReportsTheSameFiguresToPeopleAndMachines) {
  const Trajectory reference = made::straight(301, 1.0);
  Trajectory estimate = reference;
  made::transform(estimate, made::pose(0, 0.25, 0));
  const TrajectoryEvaluation evaluation = evaluate_trajectory(reference, estimate, {}, {});
  EXPECT_NE(to_text(evaluation).find("0.2500"), std::string::npos);
  EXPECT_NE(to_json(evaluation).find("\"mean_m\": 0.25"), std::string::npos);
}

}  // namespace
}  // namespace priormap
