#include "map_entropy.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

namespace priormap {
namespace {

constexpr double radius_m = 0.5, sigma_m = 0.02;

/// A square of 20 m that leans, so that it crosses voxels in all directions.
std::vector<Eigen::Vector3d> noisy_plane(std::size_t count, double noise_m) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> along(-10, 10);
  std::normal_distribution<double> across(0, noise_m);
  const Eigen::Vector3d u = Eigen::Vector3d(1, 0.3, 0.5).normalized(), v = u.unitOrthogonal(), n = u.cross(v);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(along(random) * u + along(random) * v + across(random) * n);
  return points;
}

/// Mean over points of the plane that lie at least a radius off its edges.
LocalSpread mean_spread(const std::vector<Eigen::Vector3d>& points) {
  const SpreadMap map(points, radius_m);
  LocalSpread sum{0, 0};
  int count = 0;
  for (std::size_t i = 0; i < points.size(); i += 200) {
    if (points[i].norm() > 9) continue;
    const auto spread = map.around(points[i], 10);
    sum.entropy += spread->entropy;
    sum.plane_variance_m2 += spread->plane_variance_m2;
    ++count;
  }
  return {sum.entropy / count, sum.plane_variance_m2 / count};
}

/// A uniform disc of radius r has the variance r^2 / 4 along both axes.
double entropy_of_disc(double across_m) {
  const double along_m2 = radius_m * radius_m / 4;
  return 0.5 * std::log(std::pow(2 * std::numbers::pi * std::numbers::e, 3) * along_m2 * along_m2 * across_m * across_m);
}

TEST(MapEntropy, OfAPlaneIsThatOfADiscAndItsNoise) {
  const LocalSpread spread = mean_spread(noisy_plane(600000, sigma_m));
  EXPECT_NEAR(spread.entropy, entropy_of_disc(sigma_m), 0.02);
  EXPECT_NEAR(std::sqrt(spread.plane_variance_m2), sigma_m, 0.02 * sigma_m);
}

TEST(MapEntropy, TwiceTheNoiseAddsItsLogarithm) {
  EXPECT_NEAR(mean_spread(noisy_plane(600000, 2 * sigma_m)).entropy - mean_spread(noisy_plane(600000, sigma_m)).entropy, std::log(2), 0.02);
}

TEST(MapEntropy, IsSilentWhereTooLittleLies) {
  const SpreadMap map(noisy_plane(600000, sigma_m), radius_m);
  EXPECT_TRUE(map.around(Eigen::Vector3d::Zero(), 100));
  EXPECT_FALSE(map.around(Eigen::Vector3d::Zero(), 10000));
  EXPECT_FALSE(map.around({100, 0, 0}, 1));
}

}  // namespace
}  // namespace priormap
