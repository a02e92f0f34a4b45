#include "tile_spool.hpp"

#include <algorithm>
#include <map>
#include <random>

#include "point_runs.hpp"
#include "test_prior.hpp"

namespace priormap {
namespace {

/// Points that differ in their position alone.
std::vector<PointRecord> face(std::mt19937& random, std::size_t num_points) {
  PointRecord point;
  for (std::int16_t& n : point.normal) n = std::int16_t(random());
  point.feature = random() % 1000;
  point.sigma_mm = std::uint16_t(random() % 500);
  std::vector<PointRecord> points(num_points, point);
  for (PointRecord& p : points) p.x = std::int32_t(random() % 200'000), p.y = std::int32_t(random() % 200'000), p.z = std::int32_t(random());
  return points;
}

TEST(PointRuns, ComeBackAsPoints) {
  std::mt19937 random(1);
  std::vector<PointRecord> points;
  for (const std::size_t count : {300u, 1u, 1u, 40u, 500u})
    for (const PointRecord& p : face(random, count)) points.push_back(p);
  std::vector<std::byte> runs;
  append_runs(points, runs);
  EXPECT_EQ(runs.size(), bytes_of_runs(points).value());
  EXPECT_LT(runs.size(), points.size() * sizeof(PointRecord) / 2);
  EXPECT_GE(most_points(runs), points.size());
  std::vector<PointRecord> back;
  append_points(runs, back);
  EXPECT_TRUE(std::ranges::equal(back, points, {}, sort_key, sort_key));
}

TEST(PointRuns, DoNotPayForPointsOfManySurfaces) {
  std::mt19937 random(2);
  std::vector<PointRecord> points;
  for (int i = 0; i < 500; ++i) points.push_back(face(random, 1).front());
  EXPECT_FALSE(bytes_of_runs(points));
}

TEST(TileSpool, GivesBackWhatItTookWhateverItsMemory) {
  for (const std::size_t memory_bytes : {std::size_t(0), std::size_t(200'000), std::size_t(1) << 30}) {
    const TestFolder folder;
    std::filesystem::create_directory(folder / "spill");
    TileSpool spool(folder / "spill", memory_bytes);
    std::mt19937 random(3);
    std::map<TileKey, std::vector<PointRecord>> expected;
    for (int i = 0; i < 400; ++i) {
      const TileKey key{std::int32_t(random() % 3), 0};
      const std::vector<PointRecord> points = face(random, random() % 2 ? 1 : 1 + random() % 400);
      spool.add(key, points);
      expected[key].insert(expected[key].end(), points.begin(), points.end());
    }
    EXPECT_EQ(spool.keys().size(), expected.size());
    EXPECT_EQ(spool.count({99, 99}), 0u);
    for (auto& [key, points] : expected) {
      EXPECT_EQ(spool.count(key), points.size());   // spilled, in runs or as they are
      std::vector<PointRecord> taken = spool.take(key);
      std::sort(taken.begin(), taken.end());
      std::sort(points.begin(), points.end());
      EXPECT_TRUE(std::ranges::equal(taken, points, {}, sort_key, sort_key));
      EXPECT_TRUE(spool.take(key).empty());
    }
  }
}

}  // namespace
}  // namespace priormap
