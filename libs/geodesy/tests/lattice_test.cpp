#include <priormap/geodesy/lattice.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace priormap {
namespace {

TEST(Lattice, HalvesGoUpwardsOnBothSidesOfZero) {
  for (const double base : {0.0, 5336000.0, -5336000.0})
    for (int k = -5; k <= 5; k += 2) EXPECT_EQ(lattice_steps(base + k * 0.0625), base * 1000 + k * 62.5 + 0.5) << k;
  EXPECT_TRUE(std::isnan(lattice_steps(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Lattice, OthersGoToTheNearest) {
  std::mt19937_64 random(1);
  for (const double reach : {1.0, 1e4, 1e7, 9e8}) {
    std::uniform_real_distribution<double> place(-reach, reach);
    for (int i = 0; i < 10000; ++i) {
      const double v = place(random), steps = lattice_steps(v);
      ASSERT_EQ(steps, std::floor(steps));
      ASSERT_LE(std::abs(steps - v * 1000), 0.5);
    }
  }
}

}  // namespace
}  // namespace priormap
