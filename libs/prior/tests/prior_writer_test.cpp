#include <priormap/prior/prior_writer.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/pointcloud/las.hpp>

#include "test_prior.hpp"

namespace priormap {
namespace {

using Positions = std::multiset<std::tuple<long long, long long, long long>>;

void insert_millimetres(Positions& positions, const PointCloud& cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.position(i);
    positions.emplace(std::llround(p.x() * 1000), std::llround(p.y() * 1000), std::llround(p.z() * 1000));
  }
}

Positions stored_positions(const PriorStore& store) {
  Positions positions;
  for (const TileEntry entry : store.tiles()) insert_millimetres(positions, store.load(entry.key).points);
  return positions;
}

TEST(PriorWriter, PointsComeBackToTheMillimetreAtUtmCoordinates) {
  const TestFolder folder;
  const PointCloud cloud = random_cloud(5000, 1, 300, {691'000, 5'336'000, 500});
  PriorWriter writer(folder / "prior", test_manifest({test_source("a")}), Overwrite::refuse);
  writer.add(cloud);
  const PriorManifest manifest = writer.finish(2);
  const PriorStore store(folder / "prior");
  Positions expected;
  insert_millimetres(expected, cloud);
  EXPECT_EQ(stored_positions(store), expected);
  EXPECT_EQ(manifest.num_points, cloud.size());
  EXPECT_EQ(store.manifest().num_points, cloud.size());
}

TEST(PriorWriter, EveryColumnComesBack) {
  const TestFolder folder;
  PointCloud cloud = random_cloud(2, 2, 10);
  cloud.xyz = {{1, 2, 3}, {2, 2, 3}};
  cloud.normal = {{0.6f, 0, 0.8f}, {0, 0, 0}};
  cloud.classification = {6, 2};
  cloud.sigma_m = {0.123f, std::nanf("")};
  cloud.intensity = {0.25f, 7};
  PriorWriter writer(folder / "prior", test_manifest({test_source("a")}), Overwrite::refuse);
  cloud.feature = {writer.add_feature({.source = "a", .id = "way/1", .height_rule = "tag"}), PointCloud::no_feature};
  writer.add(cloud);
  writer.finish(1);
  const PointCloud read = PriorStore(folder / "prior").load({0, 0}).points;
  ASSERT_EQ(read.size(), 2u);
  EXPECT_LT((read.normal[0] - cloud.normal[0]).norm(), 1e-4f);
  EXPECT_EQ(read.normal[1], Eigen::Vector3f::Zero());
  EXPECT_EQ(read.classification, cloud.classification);
  EXPECT_FLOAT_EQ(read.sigma_m[0], 0.123f);
  EXPECT_TRUE(std::isnan(read.sigma_m[1]));
  EXPECT_EQ(read.feature, (std::vector<std::uint32_t>{0, PointCloud::no_feature}));
  EXPECT_EQ(read.intensity, cloud.intensity);
}

TEST(PriorWriter, BytesDependOnTheSetOfPointsAlone) {
  const TestFolder folder;
  const PointCloud cloud = random_cloud(20'000, 3, 400);
  auto write = [&](const std::string& name, unsigned seed, int threads, std::size_t memory_bytes) {
    std::vector<std::uint32_t> order(cloud.size());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    PriorWriter writer(folder / name, test_manifest({test_source("a")}), Overwrite::refuse, memory_bytes);
    std::vector<std::jthread> adders;
    for (int t = 0; t < threads; ++t)
      adders.emplace_back([&, t] {
        for (std::size_t first = std::size_t(t) * 100; first < order.size(); first += std::size_t(threads) * 100)
          writer.add(cloud.select(std::span(order).subspan(first, std::min<std::size_t>(100, order.size() - first))));
      });
    adders.clear();
    writer.finish(threads);
    return folder_content(folder / name);
  };
  const auto reference = write("in_memory", 1, 1, PriorWriter::default_memory_bytes);
  EXPECT_EQ(reference.count("tiles/0_0.las"), 1u);
  EXPECT_EQ(write("other_order", 2, 3, PriorWriter::default_memory_bytes), reference);
  EXPECT_EQ(write("spilled", 3, 1, 100'000), reference);
  EXPECT_EQ(write("spilled_always", 4, 4, 0), reference);
}

TEST(PriorWriter, APointOnAnEdgeBelongsToTheTileAboveIt) {
  const TestFolder folder;
  PointCloud cloud;
  cloud.xyz = {{50, 0, 1}, {49.9994f, 0, 1}, {49.9996f, 1, 1}, {-0.001f, 50, 1}};   // the third is 50.000 on the lattice
  PriorWriter writer(folder / "prior", test_manifest({test_source("a")}, 50), Overwrite::refuse);
  writer.add(cloud);
  writer.finish(1);
  const PriorStore store(folder / "prior");
  EXPECT_EQ(store.load({1, 0}).points.size(), 2u);
  EXPECT_EQ(store.load({0, 0}).points.size(), 1u);
  EXPECT_EQ(store.load({-1, 1}).points.size(), 1u);
  EXPECT_EQ(store.index().size(), 3u);
}

TEST(PriorWriter, EachPointLiesInItsTile) {
  const TestFolder folder;
  PriorWriter writer(folder / "prior", test_manifest({test_source("a")}, 33.3), Overwrite::refuse);
  writer.add(random_cloud(3000, 5, 500, {-250, -250, 0}));
  writer.finish(2);
  const PriorStore store(folder / "prior");
  for (const TileEntry entry : store.tiles()) {
    const PointCloud points = store.load(entry.key).points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const long long x = std::llround(points.position(i).x() * 1000), y = std::llround(points.position(i).y() * 1000);
      EXPECT_TRUE(x >= entry.key.x * 33'300LL && x < (entry.key.x + 1) * 33'300LL);
      EXPECT_TRUE(y >= entry.key.y * 33'300LL && y < (entry.key.y + 1) * 33'300LL);
    }
  }
}

TEST(PriorWriter, OnePlaceOfOneFeatureIsOnePoint) {
  const TestFolder folder;
  PriorWriter writer(folder / "prior", test_manifest({test_source("a"), test_source("b")}), Overwrite::refuse);
  const std::uint32_t house = writer.add_feature({.source = "a", .id = "house"});
  const std::uint32_t shed = writer.add_feature({.source = "a", .id = "shed"});
  PointCloud cloud;
  cloud.xyz.assign(5, {1, 1, 1});
  cloud.normal = {{1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  cloud.feature = {house, house, shed, PointCloud::no_feature, PointCloud::no_feature};
  cloud.source = {0, 0, 0, 0, 1};
  writer.add(cloud);
  EXPECT_EQ(writer.finish(1).num_points, 4u);   // house, shed, and one of each source
}

TEST(PriorWriter, FeaturesAreNumberedBySourceAndIdAndPointsFollow) {
  const TestFolder folder;
  PriorWriter writer(folder / "prior", test_manifest({test_source("b"), test_source("a")}), Overwrite::refuse);
  const std::uint32_t second = writer.add_feature({.source = "b", .id = "way/1"});
  writer.add_feature({.source = "a", .id = "without points"});
  const std::uint32_t first = writer.add_feature({.source = "a", .id = "way/2"});
  EXPECT_EQ(writer.add_feature({.source = "b", .id = "way/1"}), second);
  PointCloud cloud;
  cloud.xyz = {{1, 0, 0}, {2, 0, 0}};
  cloud.source = {0, 1};
  cloud.feature = {second, first};
  writer.add(cloud);
  writer.finish(1);
  const PriorStore store(folder / "prior");
  const std::vector<Feature> features = store.features();
  ASSERT_EQ(features.size(), 2u);
  EXPECT_EQ(features[0].id, "way/2");
  EXPECT_EQ(features[1].id, "way/1");
  EXPECT_EQ(store.manifest().sources[0].id, "a");
  const PointCloud points = store.load({0, 0}).points;
  EXPECT_EQ(points.feature, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(points.source, (std::vector<std::uint16_t>{1, 0}));
}

TEST(PriorWriter, HashesInManifestAndIndexAreThoseOfTheFiles) {
  const TestFolder folder;
  PriorWriter writer(folder / "prior", test_manifest({test_source("a")}), Overwrite::refuse);
  writer.add(random_cloud(1000, 7, 200));
  const PriorManifest manifest = writer.finish(2);
  EXPECT_EQ(manifest.tiles.file_sha256, sha256_file(folder / "prior/tiles.idx"));
  EXPECT_EQ(manifest.features_sha256, sha256_file(folder / "prior/features.geojsonl"));
  const PriorStore store(folder / "prior");
  for (const TileEntry entry : store.tiles()) {
    EXPECT_EQ(entry.sha256, sha256_file(store.tile_file(entry.key)));
    EXPECT_EQ(entry.num_bytes, std::filesystem::file_size(store.tile_file(entry.key)));
  }
}

TEST(PriorWriter, ClosingTilesEarlyChangesNothing) {
  const TestFolder folder;
  const PointCloud cloud = random_cloud(5000, 9, 300);
  auto write = [&](const std::string& name, bool close) {
    PriorWriter writer(folder / name, test_manifest({test_source("b"), test_source("a")}), Overwrite::refuse);
    writer.add(cloud);
    if (close)
      for (const TileKey key : {TileKey{1, 0}, TileKey{0, 0}, TileKey{7, 7}}) writer.close_tile(key);
    writer.finish(2);
    return folder_content(folder / name);
  };
  EXPECT_EQ(write("closed", true), write("open", false));
}

TEST(PriorWriter, AClosedTileTakesNoMorePoints) {
  const TestFolder folder;
  PriorWriter writer(folder / "prior", test_manifest({test_source("a")}), Overwrite::refuse);
  PointCloud cloud;
  cloud.xyz = {{1, 1, 1}};
  writer.add(cloud);
  writer.close_tile({0, 0});
  writer.add(cloud);
  EXPECT_THROW(writer.finish(1), Error);
}

TEST(PriorWriter, ATileWithFeaturesStaysOpen) {
  const TestFolder folder;
  PriorWriter writer(folder / "prior", test_manifest({test_source("a")}), Overwrite::refuse);
  PointCloud cloud;
  cloud.xyz = {{1, 1, 1}};
  cloud.feature = {writer.add_feature({.source = "a", .id = "house"})};
  writer.add(cloud);
  EXPECT_THROW(writer.close_tile({0, 0}), Error);
}

TEST(PriorWriter, WithoutFinishNothingIsLeft) {
  const TestFolder folder;
  {
    PriorWriter writer(folder / "prior", test_manifest({test_source("a")}), Overwrite::refuse, 0);
    writer.add(random_cloud(1000, 8, 200));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

TEST(PriorWriter, RefusesWhatItCannotStore) {
  const TestFolder folder;
  EXPECT_THROW(PriorWriter(folder / "a", test_manifest({}, 0.5), Overwrite::refuse), UsageError);
  EXPECT_THROW(PriorWriter(folder / "a", test_manifest({}, 10.00001), Overwrite::refuse), UsageError);
  PriorWriter writer(folder / "b", test_manifest({test_source("a")}), Overwrite::refuse);
  PointCloud nan;
  nan.xyz = {{std::nanf(""), 0, 0}};
  EXPECT_THROW(writer.add(nan), Error);
  PointCloud stranger;
  stranger.xyz = {{0, 0, 0}};
  stranger.source = {1};
  EXPECT_THROW(writer.add(stranger), Error);
  stranger.source = {0};
  stranger.feature = {3};
  EXPECT_THROW(writer.add(stranger), Error);
}

TEST(PriorWriter, AnEmptyPriorIsAPrior) {
  const TestFolder folder;
  PriorWriter writer(folder / "prior", test_manifest({test_source("a")}), Overwrite::refuse);
  writer.finish(1);
  const PriorStore store(folder / "prior");
  EXPECT_EQ(store.manifest().num_points, 0u);
  EXPECT_TRUE(store.tiles_within({-1e9, -1e9, 1e9, 1e9}).empty());
  EXPECT_TRUE(store.features().empty());
}

}  // namespace
}  // namespace priormap
