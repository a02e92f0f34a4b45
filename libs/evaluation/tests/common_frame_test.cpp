#include <priormap/evaluation/common_frame.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "made_trajectories.hpp"
#include <priormap/core/error.hpp>
#include <priormap/evaluation/evaluate.hpp>
#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/transformer.hpp>

namespace priormap {
namespace {

// 0.3 m and 1 km east of the central meridian of zone 32 the grid is 0.9996 of the ellipsoid, and at 500 m height 0.99952 of the ground.
Trajectory kilometre_east(double east0_m) {
  Trajectory trajectory;
  for (int i = 0; i <= 10; ++i) trajectory.poses.push_back(made::pose(east0_m + 100.0 * i, 5.36e6, 500));
  trajectory.crs = "EPSG:25832";
  return trajectory;
}

TEST(CommonFrame, MeasuresMetresOnTheGroundNotOnTheGrid) {
  Trajectory reference = kilometre_east(500000), estimate = reference;
  estimate.poses.back().translation().y() += 10;
  to_common_frame(reference, estimate);
  constexpr double grid_scale = 0.9996 / (1 + 500 / 6.38e6);
  EXPECT_TRUE(reference.crs.empty() && estimate.crs.empty());
  EXPECT_NEAR((reference.poses[10].translation() - reference.poses[0].translation()).norm(), 1000 / grid_scale, 0.01);
  EXPECT_NEAR((estimate.poses[10].translation() - reference.poses[10].translation()).norm(), 10 / grid_scale, 1e-4);
  EXPECT_NEAR(reference.poses[0].translation().head<2>().norm(), 0, 1e-6) << "the origin is the reference's first pose";
}

// The same places and headings written in two zones are the same trajectory, although the two grids are turned against each other by degrees.
TEST(CommonFrame, OfTwoZonesIsOne) {
  const Crs zone_32 = Crs::parse("EPSG:25832"), zone_33 = Crs::parse("EPSG:25833");
  Trajectory reference = kilometre_east(690000), estimate;
  estimate.crs = "EPSG:25833";
  const Transformer to_33(zone_32, zone_33);
  for (const Eigen::Isometry3d& pose : reference.poses) {
    const Eigen::Vector3d here = to_33.forward(Eigen::Vector3d(pose.translation()));
    const Eigen::Vector3d ahead = to_33.forward(Eigen::Vector3d(pose * Eigen::Vector3d(1, 0, 0)));
    estimate.poses.push_back(made::pose(here.x(), here.y(), here.z(), std::atan2(ahead.y() - here.y(), ahead.x() - here.x())));
  }
  EXPECT_GT(std::abs(rotation_angle(estimate.poses[0].linear())), 1 * std::numbers::pi / 180);
  const TrajectoryEvaluation evaluation = evaluate_trajectory(reference, estimate, {}, {});
  EXPECT_LT(evaluation.ate.position_m.max, 1e-5);
  EXPECT_LT(evaluation.ate.rotation_rad.max, 1e-6);
}

TEST(CommonFrame, OfOneGeoreferencedSideNeedsAnAlignment) {
  const Trajectory reference = kilometre_east(500000), metric = made::straight(11, 100);
  EXPECT_THROW(evaluate_trajectory(reference, metric, {}, {}), CrsError);
  EvaluationOptions options;
  options.align = Alignment::se3;
  const TrajectoryEvaluation evaluation = evaluate_trajectory(reference, metric, options, {});
  EXPECT_NEAR(evaluation.ate.position_m.max, 500 * 4.8e-4, 0.01) << "the grid is 0.48 m a kilometre short of the ground";
}

TEST(CommonFrame, TrajectoriesOfDifferentPlacesAreNotComparedUnaligned) {
  const Trajectory reference = kilometre_east(500000);
  Trajectory elsewhere = kilometre_east(944000), near = kilometre_east(502500);
  try {
    evaluate_trajectory(reference, elsewhere, {}, {});
    FAIL() << "444 km apart";
  } catch (const FormatError& error) {
    const std::string message = error.what();
    for (const char* part : {"443 km apart", "reference begins at longitude 9.0000, latitude 48.39", "estimate at longitude 14.9", "--crs", "--align"})
      EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
  }
  EXPECT_NO_THROW(evaluate_trajectory(reference, near, {}, {})) << "an estimate may be lost";
  EvaluationOptions options;
  options.align = Alignment::first;
  EXPECT_NO_THROW(evaluate_trajectory(reference, elsewhere, options, {}));

  const Trajectory metric = made::straight(11, 100);
  Trajectory far = metric;
  made::transform(far, made::pose(5000, 0, 0));
  EXPECT_THROW(evaluate_trajectory(metric, far, {}, {}), FormatError);
}

TEST(CommonFrame, RefusesGeographicCoordinates) {
  Trajectory reference = kilometre_east(500000), estimate = reference;
  reference.crs = estimate.crs = "EPSG:4326";
  EXPECT_THROW(to_common_frame(reference, estimate), CrsError);
}

}  // namespace
}  // namespace priormap
