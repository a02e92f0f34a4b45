#include <priormap/prior/merge_priors.hpp>

#include <algorithm>
#include <cmath>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/pointcloud/las.hpp>
#include <priormap/prior/export_prior.hpp>

#include "test_prior.hpp"

namespace priormap {
namespace {

using Box = std::array<double, 4>;
constexpr Box everywhere{-1e9, -1e9, 1e9, 1e9};

PriorSource source(const std::string& id, const std::string& kind) {
  PriorSource s = test_source(id, kind);
  Sha256 hash;
  hash.update(id);
  s.sha256 = hash.hex_digest();
  s.attribution = "Makers of " + id;
  return s;
}

struct House {
  std::string id;
  double x, y, size_m, ground_z, height_m;
  std::string height_rule = "tag";
};

Feature feature_of(const House& h, const std::string& source_id) {
  Feature f{.source = source_id, .id = h.id, .height_m = h.height_m, .height_rule = h.height_rule, .ground_z = h.ground_z};
  f.outline = {{{{h.x, h.y}, {h.x + h.size_m, h.y}, {h.x + h.size_m, h.y + h.size_m}, {h.x, h.y + h.size_m}}}};
  return f;
}

struct Sample {
  Eigen::Vector3d position;
  Eigen::Vector3f normal;
  PointClass point_class;
};

/// Walls and the roof at 0.5 m, the whole house whatever the box.
std::vector<Sample> samples_of(const House& h) {
  std::vector<Sample> samples;
  const int n = int(h.size_m / 0.5);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      samples.push_back({{h.x + i * 0.5, h.y + j * 0.5, h.ground_z + h.height_m}, {0, 0, 1}, PointClass::building});
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k * 0.5 < h.height_m; ++k) {
      const double a = i * 0.5, z = h.ground_z + k * 0.5;
      samples.push_back({{h.x + a, h.y, z}, {0, -1, 0}, PointClass::building});
      samples.push_back({{h.x + a, h.y + h.size_m, z}, {0, 1, 0}, PointClass::building});
      samples.push_back({{h.x, h.y + a, z}, {-1, 0, 0}, PointClass::building});
      samples.push_back({{h.x + h.size_m, h.y + a, z}, {1, 0, 0}, PointClass::building});
    }
  return samples;
}

void append(PointCloud& cloud, const Sample& s, std::uint32_t feature) {
  cloud.xyz.push_back((s.position - cloud.origin).cast<float>());
  cloud.normal.push_back(s.normal);
  cloud.classification.push_back(std::uint8_t(s.point_class));
  cloud.sigma_m.push_back(0.1f);
  cloud.source.push_back(0);
  cloud.feature.push_back(feature);
}

/// A one-source prior of houses: whole features, the points inside the box.
void write_houses(const std::filesystem::path& directory, const PriorSource& source, const std::vector<House>& houses, double tile_size,
                  const Box& box = everywhere, const std::string& crs = "") {
  PriorWriter writer(directory, test_manifest({source}, tile_size, crs), Overwrite::refuse);
  for (const House& house : houses) {
    PointCloud cloud;
    cloud.origin = {house.x, house.y, 0};
    const std::uint32_t number = writer.add_feature(feature_of(house, source.id));
    for (const Sample& s : samples_of(house))
      if (s.position.x() >= box[0] && s.position.x() < box[2] && s.position.y() >= box[1] && s.position.y() < box[3])
        append(cloud, s, number);
    writer.add(cloud);
  }
  writer.finish(2);
}

/// A raster of 1 m cells over [0, extent): heights by `surface`, walls where it rises to the north by more than `least_wall_m`.
template <class Surface>
void write_raster(const std::filesystem::path& directory, const PriorSource& source, double extent, double tile_size, const Surface& surface,
                  const Box& box = everywhere, PointClass point_class = PointClass::unclassified, const std::string& crs = "",
                  const Eigen::Vector2d& corner = {0, 0}, double least_wall_m = 1e9) {
  PriorWriter writer(directory, test_manifest({source}, tile_size, crs), Overwrite::refuse);
  PointCloud cloud;
  cloud.origin = {corner.x(), corner.y(), 0};
  for (double x = 0.25; x < extent; x += 1)
    for (double y = 0.25; y < extent; y += 1)
      if (x >= box[0] && x < box[2] && y >= box[1] && y < box[3]) {
        const double here = surface(x, y), next = surface(x, y + 1);
        append(cloud, {{corner.x() + x, corner.y() + y, here}, {0, 0, 1}, point_class}, PointCloud::no_feature);
        for (double z = here; next - here > least_wall_m && z < next; z += 1)
          append(cloud, {{corner.x() + x, corner.y() + y + 0.5, z}, {0, -1, 0}, point_class}, PointCloud::no_feature);
      }
  writer.add(cloud);
  writer.finish(2);
}

double flat(double, double) { return 100; }

MergeReport merge(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& output, const MergeOptions& options = {},
                  int threads = 2) {
  return merge_priors(inputs, output, options, Overwrite::refuse, threads, "test 1");
}

std::vector<Eigen::Vector3d> points_of(const std::filesystem::path& directory, const std::string& source_id = "") {
  const PriorStore prior(directory);
  std::vector<Eigen::Vector3d> positions;
  for (const TileEntry entry : prior.tiles()) {
    const PointCloud points = prior.load(entry.key).points;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (source_id.empty() || prior.manifest().sources[points.source[i]].id == source_id) positions.push_back(points.position(i));
  }
  return positions;
}

/// The bytes that `priorexport --sort` writes.
std::string sorted_bytes(const std::filesystem::path& directory) {
  const PointCloud cloud = prior_cloud(PriorStore(directory), {.sort = true});
  const std::vector<std::byte> las = encode_las(cloud, {.offset = cloud.origin});
  return {reinterpret_cast<const char*>(las.data()), las.size()};
}

std::vector<House> random_town(unsigned seed, int count, double extent) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0, extent - 25), size(4, 24), height(2.5, 15);
  std::vector<House> houses;
  for (int i = 0; i < count; ++i)
    houses.push_back({"way/" + std::to_string(i), place(random), place(random), std::round(size(random)), 100, height(random),
                      i % 2 ? "tag" : "default"});
  return houses;
}

TEST(MergePriors, AnySplitOfACityIsTheCity) {
  // Houses lie across the edges of boxes and tiles; the raster is thinned against them and judges their guessed heights.
  const TestFolder folder;
  const double extent = 300;
  const std::vector<House> houses = random_town(1, 60, extent);
  const PriorSource osm = source("osm", "osm"), dsm = source("dsm", "raster");
  const auto surface = [](double x, double y) { return 100 + 3 * std::sin(x / 20) + (std::fmod(y, 30) > 15 ? 8 : 0); };
  const auto write_dsm = [&](const std::string& name, double tile_size, const Box& box) {
    write_raster(folder / name, dsm, extent, tile_size, surface, box, PointClass::unclassified, "", {0, 0}, 1.5);
  };
  write_houses(folder / "osm", osm, houses, 200);
  write_dsm("dsm", 200, everywhere);
  merge({folder / "osm", folder / "dsm"}, folder / "whole");
  const std::string expected = sorted_bytes(folder / "whole");

  std::mt19937 random(2);
  std::uniform_real_distribution<double> cut(0, extent);
  const double tile_sizes[] = {50, 77.7, 200, 1000};
  for (int round = 0; round < 4; ++round) {
    const double x = cut(random), y = cut(random);
    const std::vector<Box> boxes = {{-1e9, -1e9, x, y}, {x, -1e9, 1e9, y}, {-1e9, y, 1e9, 1e9}};
    std::vector<std::filesystem::path> osm_parts, parts;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      const std::string name = std::to_string(round) + "_" + std::to_string(b);
      write_houses(folder / ("osm" + name), osm, houses, tile_sizes[random() % 4], boxes[b]);
      write_dsm("dsm" + name, tile_sizes[random() % 4], boxes[b]);
      osm_parts.push_back(folder / ("osm" + name));
      parts.push_back(folder / ("dsm" + name));
    }
    std::shuffle(osm_parts.begin(), osm_parts.end(), random);
    std::shuffle(parts.begin(), parts.end(), random);
    parts.insert(parts.begin(), osm_parts.begin(), osm_parts.end());
    MergeOptions options;
    options.tile_size_m = tile_sizes[random() % 4];
    merge(parts, folder / ("merged" + std::to_string(round)), options, 1 + int(random() % 4));
    EXPECT_TRUE(sorted_bytes(folder / ("merged" + std::to_string(round))) == expected) << "round " << round;
  }
}

TEST(MergePriors, ASplitOfOneSourceIsThatSourceByteForByte) {
  const TestFolder folder;
  const std::vector<House> houses = random_town(3, 40, 300);
  const PriorSource osm = source("osm", "osm");
  write_houses(folder / "whole", osm, houses, 100);
  write_houses(folder / "west", osm, houses, 64, {-1e9, -1e9, 140, 1e9});
  write_houses(folder / "east", osm, houses, 300, {140, -1e9, 1e9, 1e9});
  MergeOptions options;
  options.tile_size_m = 100;
  merge({folder / "east", folder / "west"}, folder / "merged", options);
  const auto expected = folder_content(folder / "whole"), merged = folder_content(folder / "merged");
  for (const auto& [name, text] : expected) {
    if (name == "prior.json") continue;
    EXPECT_TRUE(merged.at(name) == text) << name;
  }
  EXPECT_EQ(merged.size(), expected.size());
}

TEST(MergePriors, NeitherThreadsNorTheOrderOfPartsChangeAByte) {
  const TestFolder folder;
  const PriorSource osm = source("osm", "osm"), dsm = source("dsm", "raster");
  write_houses(folder / "a", osm, random_town(4, 20, 200), 100, {-1e9, -1e9, 90, 1e9});
  write_houses(folder / "b", osm, random_town(4, 20, 200), 100, {90, -1e9, 1e9, 1e9});
  write_raster(folder / "c", dsm, 200, 100, flat);
  MergeOptions options;
  options.precedence = {"osm", "raster"};
  merge({folder / "a", folder / "b", folder / "c"}, folder / "abc", options, 1);
  merge({folder / "c", folder / "b", folder / "a"}, folder / "cba", options, 4);
  EXPECT_EQ(folder_content(folder / "abc"), folder_content(folder / "cba"));
}

TEST(MergePriors, MergingWithItselfChangesNothing) {
  const TestFolder folder;
  write_houses(folder / "a", source("osm", "osm"), random_town(5, 10, 100), 100);
  const MergeReport report = merge({folder / "a", folder / "a"}, folder / "merged");
  EXPECT_EQ(report.duplicates, report.kept);
  EXPECT_TRUE(sorted_bytes(folder / "merged") == sorted_bytes(folder / "a"));
}

TEST(MergePriors, NoPointIsNearOneOfHigherPrecedence) {
  // Brute force as the oracle, over three sources; points of one source stay however near they are to each other.
  const TestFolder folder;
  const double distance = 0.8;
  std::vector<PointCloud> clouds;
  std::vector<std::filesystem::path> inputs;
  for (unsigned s = 0; s < 3; ++s) {
    clouds.push_back(random_cloud(400, 10 + s, 12));
    for (Eigen::Vector3f& p : clouds.back().xyz) p.z() = std::round((100 + (p.z() - 100) / 10) * 1000) / 1000;
    const std::string name = "s" + std::to_string(s);
    PriorWriter writer(folder / name, test_manifest({source(name, "airborne")}, 5), Overwrite::refuse);
    writer.add(clouds.back());
    writer.finish(1);
    inputs.push_back(folder / name);
  }
  std::vector<Eigen::Vector3d> kept;
  for (const PointCloud& cloud : clouds) {
    const std::size_t above = kept.size();
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (std::none_of(kept.begin(), kept.begin() + std::ptrdiff_t(above),
                       [&](const Eigen::Vector3d& p) { return (p - cloud.position(i)).norm() < distance; }))
        kept.push_back(cloud.position(i));
  }
  MergeOptions options;
  options.min_distance_m = distance;
  const MergeReport report = merge(inputs, folder / "merged", options);
  EXPECT_EQ(report.kept, kept.size());
  EXPECT_EQ(report.kept + report.thinned, 1200u);
  EXPECT_GT(report.thinned, 100u);
  options.min_distance_m = 0;
  EXPECT_EQ(merge(inputs, folder / "all", options).kept, 1200u);
}

TEST(MergePriors, PrecedenceIsTheOrderOfTheArgumentsUnlessNamed) {
  const TestFolder folder;
  write_raster(folder / "a", source("a", "raster"), 10, 100, flat);
  write_raster(folder / "b", source("b", "airborne"), 10, 100, [](double, double) { return 100.05; });
  merge({folder / "a", folder / "b"}, folder / "ab");
  EXPECT_EQ(points_of(folder / "ab", "a").size(), 100u);
  EXPECT_EQ(points_of(folder / "ab", "b").size(), 0u);
  merge({folder / "b", folder / "a"}, folder / "ba");
  EXPECT_EQ(points_of(folder / "ba", "a").size(), 0u);
  MergeOptions options;
  options.precedence = {"a"};
  merge({folder / "b", folder / "a"}, folder / "named", options);
  EXPECT_EQ(points_of(folder / "named", "a").size(), 100u);
  options.precedence = {"c"};
  EXPECT_THROW(merge({folder / "b", folder / "a"}, folder / "unknown", options), UsageError);
}

TEST(MergePriors, ARasterGivesWayToModelsAndIsRoofEvidenceInsideOutlines) {
  for (const std::string kind : {"citygml", "cityjson", "osm", "footprints"}) {
    const TestFolder folder;
    write_houses(folder / "houses", source("houses", kind), {{"h", 10, 10, 10, 100, 6}}, 16);
    write_raster(folder / "dsm", source("dsm", "raster"), 40, 16, [](double x, double y) {
      return x > 10 && x < 20 && y > 10 && y < 20 ? 109.0 : 100.0;
    });
    const MergeReport report = merge({folder / "houses", folder / "dsm"}, folder / "merged");
    const auto raster = points_of(folder / "merged", "dsm");
    const auto inside = std::ranges::count_if(raster, [](const Eigen::Vector3d& p) { return p.z() > 105; });
    const bool is_model = kind.starts_with("city");
    EXPECT_EQ(inside, is_model ? 0 : 100) << kind;
    EXPECT_EQ(report.under_models, is_model ? 100u : 0u) << kind;
  }
}

TEST(MergePriors, TheWallsOfARasterStayBesideThoseOfOthers) {
  for (const std::string kind : {"osm", "citygml"}) {
    const TestFolder folder;
    write_houses(folder / "houses", source("houses", kind), {{"h", 10, 10, 10, 100, 6, "tag"}}, 16);
    PriorWriter writer(folder / "dsm", test_manifest({source("dsm", "raster")}, 16), Overwrite::refuse);
    PointCloud cloud;
    for (const double x : {8.5, 11.5, 30.0})   // before and behind the house's wall at x = 10, and alone
      for (double y = 10.5; y < 20; y += 1)
        for (double z = 100.5; z < 110; z += 1) append(cloud, {{x, y, z}, {-1, 0, 0}, PointClass::unclassified}, PointCloud::no_feature);
    writer.add(cloud);
    writer.finish(1);
    const MergeReport report = merge({folder / "houses", folder / "dsm"}, folder / "merged");
    EXPECT_EQ(points_of(folder / "merged", "dsm").size(), 300u) << kind;
    EXPECT_EQ(report.contradicted, 0u) << "a wall says nothing of a roof";
  }
}

TEST(MergePriors, GuessedHeightsGiveWayToWhatASurfaceRasterSaw) {
  const TestFolder folder;
  const std::vector<House> houses = {
      {"tall", 10, 10, 10, 100, 8, "default"},       // really 20 m
      {"low", 40, 10, 10, 100, 8, "levels"},         // really 3 m
      {"right", 10, 40, 10, 100, 8, "default"},      // really 8.3 m
      {"tagged", 40, 40, 10, 100, 8, "tag"},         // really 20 m
      {"unseen", 70, 70, 10, 100, 8, "default"},     // outside the raster
  };
  const auto inside = [](double x, double y, double x0, double y0) { return x >= x0 && x < x0 + 10 && y >= y0 && y < y0 + 10; };
  const auto surface = [&](double x, double y) {
    if (inside(x, y, 10, 10) || inside(x, y, 40, 40)) return 120.0;
    if (inside(x, y, 40, 10)) return 103.0;
    return inside(x, y, 10, 40) ? 108.3 : 100.0;
  };
  write_houses(folder / "osm", source("osm", "osm"), houses, 30);
  write_raster(folder / "dsm", source("dsm", "raster"), 60, 30, surface);
  const MergeReport report = merge({folder / "osm", folder / "dsm"}, folder / "merged");
  const auto osm = points_of(folder / "merged", "osm");
  const auto count = [&](double x0, double y0, double low, double high) {
    return std::ranges::count_if(osm, [&](const Eigen::Vector3d& p) {
      return p.x() >= x0 && p.x() <= x0 + 10 && p.y() >= y0 && p.y() <= y0 + 10 && p.z() > low && p.z() < high;
    });
  };
  EXPECT_EQ(count(10, 10, 107.9, 108.1), 0) << "the roof is not at 8 m";
  EXPECT_GT(count(10, 10, 107.2, 107.9), 0) << "its walls are there";
  EXPECT_EQ(count(40, 10, 104.31, 109), 0) << "neither roof nor walls stand above 3 m";
  EXPECT_GT(count(40, 10, 102, 104.31), 0);
  EXPECT_EQ(count(10, 40, 107.9, 108.1), 441);
  EXPECT_EQ(count(40, 40, 107.9, 108.1), 441) << "tags are believed";
  EXPECT_EQ(count(70, 70, 107.9, 108.1), 441);
  EXPECT_GT(report.contradicted, 441u);

  MergeOptions options;
  options.keep_guessed_roofs = true;
  EXPECT_EQ(merge({folder / "osm", folder / "dsm"}, folder / "kept", options).contradicted, 0u);
  write_raster(folder / "dtm", source("dtm", "raster"), 60, 30, flat, everywhere, PointClass::ground);
  EXPECT_EQ(merge({folder / "osm", folder / "dtm"}, folder / "terrain").contradicted, 0u) << "bare terrain says nothing about roofs";
}

TEST(MergePriors, LicencesAndAttributionsGoAlong) {
  const TestFolder folder;
  PriorSource west = source("osm", "osm"), east = west;
  west.facts = {{"buildings", "3"}, {"spacing", "0.5"}};
  east.facts = {{"buildings", "4"}, {"spacing", "0.5"}};
  east.attribution = "Another maker";
  write_houses(folder / "west", west, {{"h", 10, 10, 5, 0, 3}}, 50);
  write_houses(folder / "east", east, {{"g", 70, 10, 5, 0, 3}}, 50);
  write_raster(folder / "dsm", source("dsm", "raster"), 10, 50, flat);
  const PriorManifest manifest = merge({folder / "west", folder / "dsm", folder / "east"}, folder / "merged").manifest;
  ASSERT_EQ(manifest.sources.size(), 2u);
  EXPECT_EQ(manifest.sources[0].attribution, "Another maker; Makers of osm");
  EXPECT_EQ(manifest.sources[0].facts, (std::vector<std::pair<std::string, std::string>>{{"spacing", "0.5"}}));
  EXPECT_EQ(manifest.sources[1].precedence, 1);
  const std::string text = file_text(folder / "merged/ATTRIBUTION.txt");
  for (const std::string part : {"Makers of osm", "Another maker", "Makers of dsm", "ODbL-1.0"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST(MergePriors, DifferentFilesUnderOneIdStayApart) {
  const TestFolder folder;
  PriorSource a = source("osm", "osm"), b = a;
  b.sha256 = std::string(64, 'b');
  write_houses(folder / "a", a, {{"h", 10, 10, 5, 0, 3}}, 50);
  write_houses(folder / "b", b, {{"h", 30, 10, 5, 0, 3}}, 50);
  const PriorManifest manifest = merge({folder / "a", folder / "b"}, folder / "merged").manifest;
  ASSERT_EQ(manifest.sources.size(), 2u);
  EXPECT_NE(manifest.sources[0].id, manifest.sources[1].id);
  EXPECT_EQ(manifest.num_features, 2u);
}

TEST(MergePriors, HeightsAreNeverMixedInSilence) {
  const TestFolder folder;
  const std::vector<House> houses = {{"h", 691'010, 5'336'010, 5, 500, 3}};
  write_houses(folder / "null", source("null", "osm"), houses, 200, everywhere, "EPSG:25832");
  write_houses(folder / "dhhn", source("dhhn", "osm"), houses, 200, everywhere, "EPSG:25832+7837");
  write_houses(folder / "egm", source("egm", "osm"), houses, 200, everywhere, "EPSG:25832+5773");
  EXPECT_THROW(merge({folder / "null", folder / "dhhn"}, folder / "x"), CrsError);
  EXPECT_THROW(merge({folder / "dhhn", folder / "egm"}, folder / "x"), CrsError);
  EXPECT_FALSE(std::filesystem::exists(folder / "x"));

  MergeOptions options;
  options.assume_vertical = "EPSG:7837";
  const PriorManifest manifest = merge({folder / "null", folder / "dhhn"}, folder / "assumed", options).manifest;
  EXPECT_EQ(manifest.vertical, "EPSG:7837");
  EXPECT_EQ(manifest.sources[0].id, "null");
  EXPECT_EQ(manifest.sources[0].assumed_vertical, "EPSG:7837");
  EXPECT_EQ(manifest.sources[1].assumed_vertical, "");
}

TEST(MergePriors, AnotherZoneComesIntoTheFirstPriorsCrs) {
  // One house, in zone 32 and, by PROJ, in zone 33: the same place.
  const TestFolder folder;
  const Eigen::Vector3d in_32(830'000, 5'330'000, 0);
  const Eigen::Vector3d in_33 = Transformer(Crs::parse("EPSG:25832"), Crs::parse("EPSG:25833")).forward(in_32);
  write_raster(folder / "a", source("a", "airborne"), 20, 200, flat, everywhere, PointClass::ground, "EPSG:25832", in_32.head<2>());
  write_raster(folder / "b", source("b", "airborne"), 1, 200, flat, everywhere, PointClass::ground, "EPSG:25833", in_33.head<2>());
  MergeOptions options;
  options.min_distance_m = 0;
  const PriorManifest manifest = merge({folder / "a", folder / "b"}, folder / "merged", options).manifest;
  EXPECT_EQ(manifest.crs, "EPSG:25832");
  const auto moved = points_of(folder / "merged", "b");
  ASSERT_EQ(moved.size(), 1u);
  const Eigen::Vector3d expected = Transformer(Crs::parse("EPSG:25833"), Crs::parse("EPSG:25832"))
                                       .forward(Eigen::Vector3d(std::round((in_33.x() + 0.25) * 1000) / 1000,
                                                                std::round((in_33.y() + 0.25) * 1000) / 1000, 0));
  EXPECT_NEAR(moved[0].x(), expected.x(), 0.00051);
  EXPECT_NEAR(moved[0].y(), expected.y(), 0.00051);
  EXPECT_EQ(moved[0].z(), 100);
}

TEST(MergePriors, APriorFarFromTheOthersIsWarnedOf) {
  const TestFolder folder;
  const auto write = [&](const std::string& name, const std::string& crs, const Eigen::Vector2d& corner) {
    write_raster(folder / name, source(name, "airborne"), 2, 200, flat, everywhere, PointClass::ground, crs, corner);
  };
  write("munich", "EPSG:25832", {691'000, 5'336'000});
  write("augsburg", "EPSG:25832", {640'000, 5'358'000});          // 55 km from Munich
  write("between", "EPSG:25832", {664'000, 5'347'000});
  write("munich_33", "EPSG:25833", {245'000, 5'338'000});         // the zone does not make it another place
  write("berlin", "EPSG:25833", {391'000, 5'820'000});            // 504 km from Munich
  const auto warning = [&](const std::vector<std::string>& names) {
    std::vector<std::filesystem::path> inputs;
    for (const std::string& name : names) inputs.push_back(folder / name);
    std::string text;
    Events events;
    events.warning = [&](const std::string& message) { text += message; };
    merge_priors(inputs, folder / "merged", {}, Overwrite::allow, 1, "test", events);
    return text;
  };
  EXPECT_EQ(warning({"munich", "munich_33"}), "");
  EXPECT_EQ(warning({"munich", "augsburg", "between"}), "") << "a chain of neighbours";
  EXPECT_NE(warning({"munich", "augsburg"}).find("augsburg: lies 55 km"), std::string::npos);
  EXPECT_NE(warning({"berlin", "munich", "munich_33"}).find("munich: lies 50"), std::string::npos) << warning({"berlin", "munich", "munich_33"});
}

TEST(MergePriors, ADamagedTileIsRefused) {
  const TestFolder folder;
  write_raster(folder / "a", source("a", "raster"), 10, 100, flat);
  const auto tile = folder / "a/tiles/0_0.las";
  std::string bytes = file_text(tile);
  bytes[1000] = char(bytes[1000] ^ 1);
  std::ofstream(tile, std::ios::binary) << bytes;
  EXPECT_THROW(merge({folder / "a"}, folder / "merged"), FormatError);
  EXPECT_FALSE(std::filesystem::exists(folder / "merged"));
}

}  // namespace
}  // namespace priormap
