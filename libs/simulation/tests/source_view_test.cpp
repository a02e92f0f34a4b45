#include <priormap/simulation/source_view.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace priormap {
namespace {

Polygon2 house() { return {{{10, 5}, {22, 5}, {22, 13}, {10, 13}}, {{{14, 8}, {14, 10}, {17, 10}, {17, 8}}}}; }

TEST(BuildingError, ShiftsAndTurnsRigidlyAndBack) {
  BuildingError error;
  error.shift_m = {0.4, -0.3};
  error.rotation = 0.01;
  const Polygon2 truth = house(), source = error.apply(truth), back = error.undo(source);
  EXPECT_NEAR(area(source), area(truth), 1e-9);
  EXPECT_TRUE((0.25 * (source.exterior[0] + source.exterior[1] + source.exterior[2] + source.exterior[3])).isApprox(Eigen::Vector2d(16.4, 8.7), 1e-9));
  const Eigen::Vector2d edge = source.exterior[1] - source.exterior[0];
  EXPECT_NEAR(std::atan2(edge.y(), edge.x()), 0.01, 1e-9);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((back.exterior[i] - truth.exterior[i]).norm(), 1e-9);
    EXPECT_LT((back.holes[0][i] - truth.holes[0][i]).norm(), 1e-9);
  }
}

TEST(BuildingError, HasTheStatisticsAskedFor) {
  const SourceErrorOptions options;
  constexpr int count = 4000;
  double missing = 0, without_height = 0, squares_x = 0, squares_turn = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const BuildingError error = draw_building_error(options, 11, i);
    missing += error.missing;
    without_height += !error.has_height_tag && !error.has_levels_tag;
    squares_x += error.shift_m.x() * error.shift_m.x();
    squares_turn += error.rotation * error.rotation;
  }
  EXPECT_NEAR(missing / count, 0.1, 0.02);
  EXPECT_NEAR(without_height / count, 0.6, 0.03);
  EXPECT_NEAR(std::sqrt(squares_x / count), 0.3, 0.015);
  EXPECT_NEAR(std::sqrt(squares_turn / count) * 180 / std::numbers::pi, 0.4, 0.02);
}

TEST(BuildingError, OneOptionDoesNotMoveTheOthersDraws) {
  SourceErrorOptions more_missing;
  more_missing.missing_share = 0.3;
  for (std::size_t i = 0; i < 50; ++i) {
    const BuildingError a = draw_building_error({}, 1, i), b = draw_building_error(more_missing, 1, i);
    EXPECT_EQ(a.shift_m, b.shift_m);
    EXPECT_LE(a.missing, b.missing);
  }
}

}  // namespace
}  // namespace priormap
