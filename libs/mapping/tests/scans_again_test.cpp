#include "scans_again.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "town.hpp"

namespace priormap {
namespace {

/// Which surfels the keyframes have in each of three passes, and how often a scan was read for them.
struct Passes {
  static constexpr std::size_t num_keyframes = 4;
  std::size_t reads = 0;
  std::vector<SurfelCloud> clouds;

  explicit Passes(std::size_t room_bytes) {
    const ReadScan read = [this](std::size_t index) {
      ++reads;
      return test::scan_from(30, test::pose(0.4 * static_cast<double>(index), 0, 1.7, 0), index);
    };
    ScansAgain scans(read, 1.0, num_keyframes, room_bytes);
    for (int pass = 0; pass < 3; ++pass)
      for (std::size_t k = 0; k < num_keyframes; ++k) clouds.push_back(*scans.surfels_of(k, {5 * k, 0, {}, Eigen::Isometry3d::Identity()}));
  }
};

bool same(const SurfelCloud& a, const SurfelCloud& b) {
  return a.origin == b.origin && a.normals.size() == a.size() && a.normals == b.normals && std::ranges::equal(a.surfels, b.surfels, [](const Surfel& x, const Surfel& y) { return x.mean == y.mean && x.count == y.count && x.covariance == y.covariance; });
}

TEST(ScansAgain, WhereThereIsRoomEachScanIsReadOnce) { EXPECT_EQ(Passes(std::numeric_limits<std::size_t>::max()).reads, Passes::num_keyframes); }

TEST(ScansAgain, HowMuchRoomThereIsMakesNoDifferenceToTheSurfels) {
  const Passes all(std::numeric_limits<std::size_t>::max()), none(0), one(all.clouds[0].size() * (sizeof(Surfel) + sizeof(Eigen::Vector3f)));
  EXPECT_EQ(none.reads, 3 * Passes::num_keyframes);
  EXPECT_EQ(one.reads, 1 + 3 * (Passes::num_keyframes - 1));
  ASSERT_GT(all.clouds[0].size(), 100u);
  EXPECT_FALSE(same(all.clouds[0], all.clouds[1]));
  for (std::size_t i = 0; i < all.clouds.size(); ++i) {
    EXPECT_TRUE(same(all.clouds[i], none.clouds[i])) << i;
    EXPECT_TRUE(same(all.clouds[i], one.clouds[i])) << i;
    EXPECT_TRUE(same(all.clouds[i], all.clouds[i % Passes::num_keyframes])) << i;
  }
}

}  // namespace
}  // namespace priormap
