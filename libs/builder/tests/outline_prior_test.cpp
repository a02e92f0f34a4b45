#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <priormap/builder/outline_prior.hpp>
#include <priormap/core/error.hpp>
#include <priormap/prior/prior_store.hpp>
#include <priormap/sources/raster_writer.hpp>
#include <random>
#include <set>
#include <tuple>

namespace priormap {
namespace {

namespace fs = std::filesystem;

class OutlinePrior : public testing::Test {
 protected:
  OutlinePrior() : folder_(fs::path(testing::TempDir()) / (std::string("outline_prior_") + testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ / "town.txt") << "stands for the file that the outlines came from";
    options_.crs = "EPSG:25832";
  }
  ~OutlinePrior() override { fs::remove_all(folder_); }

  static constexpr double east = 690000, north = 5340000;

  static Footprint box(const std::string& id, double x, double y, double width, double depth) {
    Footprint footprint;
    footprint.id = id;
    footprint.rings = {{{east + x, north + y}, {east + x + width, north + y}, {east + x + width, north + y + depth}, {east + x, north + y + depth}}};
    return footprint;
  }

  OutlineReport build(const std::vector<Footprint>& footprints, const std::string& name = "prior", int threads = 2) {
    OutlineInput input{FootprintList(footprints), {{folder_ / "town.txt", std::string(64, '0')}}, {Crs::parse("EPSG:25832")}, "footprints", "", ""};
    return build_outline_prior(std::move(input), options_, outline_options_, folder_ / name, Overwrite::refuse, "test", {}, threads, events_);
  }

  std::vector<Eigen::Vector3d> points(const std::string& name = "prior") {
    const PriorStore store(folder_ / name);
    std::vector<Eigen::Vector3d> all;
    for (const TileEntry& tile : store.tiles()) {
      const PriorTile loaded = store.load(tile.key);
      for (std::size_t i = 0; i < loaded.points.size(); ++i) all.push_back((loaded.points.position(i) * 1000).array().round());
    }
    std::ranges::sort(all, [](const auto& a, const auto& b) { return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end()); });
    return all;
  }

  std::vector<Eigen::Vector3f> normals() {
    const PriorStore store(folder_ / "prior");
    std::vector<Eigen::Vector3f> all;
    for (const TileEntry& tile : store.tiles()) std::ranges::copy(store.load(tile.key).points.normal, std::back_inserter(all));
    return all;
  }

  /// Ground: 500 m at x = 0, rising by `slope` to the east, with cells of 10 m and noise.
  fs::path write_terrain(double slope, double noise_m) {
    HeightGrid grid{east - 200, north + 300, 10, 60, 60, {}};
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, noise_m);
    for (std::size_t row = 0; row < grid.rows; ++row)
      for (std::size_t column = 0; column < grid.columns; ++column)
        grid.heights_m.push_back(static_cast<float>(500 + slope * (grid.cell_centre(column, row).x() - east) + (noise_m > 0 ? noise(random) : 0)));
    write_geotiff(folder_ / "terrain.tif", grid, Crs::parse("EPSG:25832+7837"));
    return folder_ / "terrain.tif";
  }

  fs::path folder_;
  PriorOptions options_;
  OutlineOptions outline_options_;
  Events events_;
};

TEST_F(OutlinePrior, HousesOnBothSidesOfTheAntimeridianLieInTheZoneThere) {
  std::vector<Footprint> houses;
  for (const double west : {179.999, -179.999}) houses.push_back({"way/" + std::to_string(houses.size()), {{{west, -17}, {west + 1e-4, -17}, {west + 1e-4, -16.9999}, {west, -16.9999}}}, {}});
  options_.crs.clear();
  OutlineInput input{FootprintList(houses), {{folder_ / "town.txt", std::string(64, '0')}}, {Crs::parse("EPSG:4326")}, "osm", "", ""};
  const OutlineReport report = build_outline_prior(std::move(input), options_, outline_options_, folder_ / "prior", Overwrite::refuse, "test", {}, 2, events_);
  EXPECT_TRUE(report.manifest.crs == "EPSG:32760" || report.manifest.crs == "EPSG:32701") << report.manifest.crs;
  EXPECT_LT((report.manifest.max - report.manifest.min).head<2>().norm(), 300);
}

TEST_F(OutlinePrior, RoofsSlopeFromTrueNorthNotFromTheGrids) {
  Footprint shed{"way/1", {{{5.3, 60.4}, {5.3002, 60.4}, {5.3002, 60.4001}, {5.3, 60.4001}}}, {}};
  shed.attributes.roof_shape = RoofShape::skillion;
  shed.attributes.roof_direction_deg = 180;
  options_.crs = "EPSG:25833";
  OutlineInput input{FootprintList(std::vector{shed}), {{folder_ / "town.txt", std::string(64, '0')}}, {Crs::parse("EPSG:4326")}, "osm", "", ""};
  build_outline_prior(std::move(input), options_, outline_options_, folder_ / "prior", Overwrite::refuse, "test", {}, 2, events_);
  // Meridian convergence of zone 33 in Bergen: atan(tan(5.3 - 15) sin(60.4)) = -8.45 degrees, so that true south lies west of the grid's.
  const double convergence = std::atan(std::tan((5.3 - 15) * M_PI / 180) * std::sin(60.4 * M_PI / 180));
  std::size_t on_roof = 0;
  for (const Eigen::Vector3f& normal : normals()) {
    if (normal.z() < 0.3f) continue;
    EXPECT_NEAR(std::atan2(normal.x(), -normal.y()), convergence, 1e-3);
    ++on_roof;
  }
  EXPECT_GT(on_roof, 100u);
}

TEST_F(OutlinePrior, DirectionsInWordsMeanTheNearestWallAndNumbersThemselves) {
  const double turn = -30 * M_PI / 180, c = std::cos(turn), s = std::sin(turn);   // clockwise
  Footprint house = box("way/1", 0, 0, 10, 14);
  for (Eigen::Vector2d& p : house.rings[0]) {
    const Eigen::Vector2d d = p - Eigen::Vector2d(east, north);
    p = Eigen::Vector2d(east + c * d.x() - s * d.y(), north + s * d.x() + c * d.y());
  }
  house.attributes.roof_shape = RoofShape::skillion;
  for (const auto& [direction, half_step, expected] : {std::tuple(22.5, 11.25, 30.0), {45.0, 22.5, 30.0}, {45.0, 11.25, 45.0}, {22.5, 0.0, 22.5}}) {
    house.attributes.roof_direction_deg = direction;
    house.attributes.roof_direction_half_step_deg = half_step;
    fs::remove_all(folder_ / "prior");
    build({house});
    for (const Eigen::Vector3f& normal : normals()) {
      if (normal.z() < 0.3f) continue;
      EXPECT_NEAR(std::atan2(normal.x(), normal.y()) * 180 / M_PI, expected, 0.1) << direction << " within " << half_step;
    }
  }
}

TEST_F(OutlinePrior, ABlockHasWallsAndARoof) {
  const OutlineReport report = build({box("a", 0, 0, 10, 6)});
  EXPECT_EQ(report.counts.outlines, 1u);
  EXPECT_FALSE(report.manifest.vertical);
  const auto all = points();
  EXPECT_EQ(all.size(), 2 * (20 + 12) * 17u + 19 * 11) << "walls every half metre from 0 to 8 m, and what lies inside the roof's edge";
  const PriorStore store(folder_ / "prior");
  ASSERT_EQ(store.features().size(), 1u);
  EXPECT_EQ(store.features()[0].id, "a");
  EXPECT_EQ(store.features()[0].height_rule, "default");
  const PriorTile tile = store.load(store.tiles()[0].key);
  for (std::size_t i = 0; i < tile.points.size(); ++i) {
    const Eigen::Vector3d p = tile.points.position(i) - Eigen::Vector3d(east + 5, north + 3, 4);
    EXPECT_GT(tile.points.normal[i].cast<double>().dot(p), 0) << "normals look outward";
    EXPECT_EQ(tile.points.classification[i], std::uint8_t(PointClass::building));
    EXPECT_EQ(tile.points.sigma_m[i], tile.points.normal[i].z() > 0.5f ? 4 : 1) << "where the outline is, and how high a guessed roof";
  }
}

TEST_F(OutlinePrior, ARoofIsAsUncertainAsTheRuleThatGaveItsHeight) {
  outline_options_.sigma_m = 0.7;
  outline_options_.height_sigma_m = 0.5;
  outline_options_.levels_sigma_m = 1.5;
  outline_options_.default_sigma_m = 3;
  std::vector<Footprint> town{box("tag", 0, 0, 10, 6), box("levels", 20, 0, 10, 6), box("default", 40, 0, 10, 6)};
  town[0].attributes.height_m = 9;
  town[1].attributes.levels = 3;
  build(town);
  const PriorStore store(folder_ / "prior");
  const auto features = store.features();
  std::map<std::string, std::set<float>> walls, roofs;
  for (const TileEntry& tile : store.tiles()) {
    const PointCloud points = store.load(tile.key).points;
    for (std::size_t i = 0; i < points.size(); ++i) (points.normal[i].z() > 0.5f ? roofs : walls)[features[points.feature[i]].id].insert(points.sigma_m[i]);
  }
  for (const auto& [id, sigmas] : walls) EXPECT_EQ(sigmas, std::set<float>{0.7f}) << id;
  EXPECT_EQ(roofs["tag"], std::set<float>{0.5f});
  EXPECT_EQ(roofs["levels"], std::set<float>{1.5f});
  EXPECT_EQ(roofs["default"], std::set<float>{3.0f});
}

/// Work goes by squares; x = 0 is an edge of one.
TEST_F(OutlinePrior, NeighboursAcrossTheEdgeOfASquareAreNeighbours) {
  const auto terrace = [&](double x) {
    std::vector<Footprint> town{box("low", x - 10, 0, 10, 8), box("high", x, 0, 10, 8), box("hall", x - 20, 20, 40, 10), box("tower", x + 10, 20, 10, 10), box("nave", x - 20, 20, 30, 10)};
    town[1].attributes.height_m = 12;
    town[2].attributes.height_m = 20;
    town[3].kind = town[4].kind = Footprint::Kind::part;
    return town;
  };
  build(terrace(0), "across");
  build(terrace(100), "within");
  std::vector<Eigen::Vector3d> across = points("across"), within = points("within");
  for (Eigen::Vector3d& p : within) p.x() -= 100'000;
  EXPECT_EQ(across, within);
}

TEST_F(OutlinePrior, ARoofThatCannotBeBuiltIsFlatAndCounted) {
  Footprint yard = box("yard", 0, 0, 30, 30);
  yard.rings.push_back(box("", 10, 10, 10, 10).rings[0]);
  yard.attributes.height_m = 12;
  yard.attributes.roof_shape = RoofShape::dome;
  Footprint odd = box("odd", 50, 0, 10, 10);
  odd.attributes.height_m = 12;
  odd.attributes.roof_shape = RoofShape::other;
  const OutlineReport report = build({yard, odd});
  EXPECT_EQ(report.diagnostics.counts().at(DiagnosticCode::unsupported_roof), 2u);
  for (const Eigen::Vector3d& p : points()) EXPECT_LE(p.z(), 12000);
}

TEST_F(OutlinePrior, ARoofWithoutHeightIsFlatAsStated) {
  std::vector<Footprint> town{box("by height", 0, 0, 10, 10), box("by angle", 50, 0, 10, 10)};
  for (Footprint& house : town) {
    house.attributes.height_m = 6;
    house.attributes.roof_shape = RoofShape::gabled;
  }
  town[0].attributes.roof_height_m = 0;
  town[1].attributes.roof_angle_deg = 0;
  EXPECT_EQ(build(town).diagnostics.total(), 0u);
  for (const Eigen::Vector3d& p : points()) EXPECT_LE(p.z(), 6000);
}

TEST_F(OutlinePrior, AnOutlineGivenTwiceStandsOnce) {
  Footprint house = box("house", 0, 0, 10, 6), again = house, raised = house;
  again.id = "again";
  std::ranges::rotate(again.rings[0], again.rings[0].begin() + 2);
  std::ranges::reverse(again.rings[0]);
  again.attributes.height_m = 6;
  raised.id = "raised";   // stands on the others
  raised.attributes.min_height_m = 20;
  raised.attributes.height_m = 25;
  build({again, raised}, "once");
  for (const auto& [name, town] : {std::pair("in order", std::vector{house, again, raised}), {"turned round", std::vector{raised, again, house}}}) {
    const OutlineReport report = build(town, name);
    EXPECT_EQ(report.counts.outlines, 2u);
    EXPECT_EQ(report.diagnostics.counts(), (std::map<DiagnosticCode, std::size_t>{{DiagnosticCode::repeated_outline, 1}}));
    EXPECT_EQ(report.diagnostics.entries().front().feature, "house") << "what says its height stays";
    EXPECT_EQ(points(name), points("once"));
  }
}

TEST_F(OutlinePrior, WhatIsLargerThanAnyBuildingIsCountedAndLeftOut) {
  const OutlineReport report = build({box("house", 0, 0, 10, 10), box("continent", 0, 50, 1e6, 1e6), box("needle", 0, 20, 6000, 1)});
  EXPECT_EQ(report.counts.outlines, 1u);
  EXPECT_EQ(report.diagnostics.counts().at(DiagnosticCode::implausible_size), 2u);
}

TEST_F(OutlinePrior, WallsStartAtTheLowestGroundAndHeightsCountFromTheMedian) {
  outline_options_.terrain = write_terrain(0.2, 0).string();
  const OutlineReport report = build({box("a", 0, 0, 20, 20)});
  EXPECT_EQ(report.manifest.vertical, "EPSG:7837") << "the terrain brings its heights along";
  EXPECT_NEAR(report.manifest.min.z(), 500, 0.01);
  EXPECT_NEAR(report.manifest.max.z(), 502 + 8, 0.3);
}

TEST_F(OutlinePrior, ANoisyTerrainDoesNotSinkTheRoofs) {
  outline_options_.terrain = write_terrain(0, 2).string();
  std::vector<Footprint> town;
  for (int i = 0; i < 25; ++i) town.push_back(box("b" + std::to_string(i), 40.0 * (i % 5), 40.0 * (i / 5), 30, 30));
  build(town);
  double sum = 0;
  for (const Feature& feature : PriorStore(folder_ / "prior").features()) sum += feature.ground_z;
  EXPECT_NEAR(sum / 25, 500, 0.5) << "the lowest of a dozen noisy cells would lie some 2 m deeper";
}

TEST_F(OutlinePrior, OutsideTheTerrainBuildingsAreCountedUnlessAGroundHeightServes) {
  outline_options_.terrain = write_terrain(0, 0).string();
  const std::vector<Footprint> town{box("near", 0, 0, 20, 20), box("far", 5000, 0, 20, 20)};
  EXPECT_EQ(build(town).diagnostics.counts().at(DiagnosticCode::outside_terrain), 1u);
  outline_options_.ground_height_m = 490;
  const OutlineReport served = build(town, "served");
  EXPECT_EQ(served.diagnostics.total(), 0u);
  EXPECT_EQ(served.manifest.min.z(), 490);
}

TEST_F(OutlinePrior, ATerrainOfAnotherPlaceIsNamed) {
  outline_options_.terrain = write_terrain(0, 0).string();
  try {
    build({box("far", 5000, 0, 20, 20)});
    FAIL();
  } catch (const FormatError& error) {
    EXPECT_NE(std::string(error.what()).find("terrain.tif: has no height under any building of "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(" (W,S,E,N), the terrain over 11.55"), std::string::npos) << error.what();
  }
}

TEST_F(OutlinePrior, TerrainAndSurfaceGivenTheWrongWayRoundAreTold) {
  std::vector<std::string> warnings;
  events_.warning = [&](const std::string& text) { warnings.push_back(text); };
  std::vector<Footprint> town;
  for (int i = 0; i < 5; ++i) town.push_back(box(std::to_string(i), 30 * i, 0, 10, 10));
  HeightGrid surface{east - 50, north + 50, 1, 250, 100, {}};
  for (std::size_t row = 0; row < surface.rows; ++row)
    for (std::size_t column = 0; column < surface.columns; ++column) {
      const Eigen::Vector2d p = surface.cell_centre(column, row) - Eigen::Vector2d(east, north);
      surface.heights_m.push_back(p.y() > 0 && p.y() < 10 && p.x() > 0 && std::fmod(p.x(), 30) < 10 ? 508.f : 500.f);
    }
  write_geotiff(folder_ / "dsm.tif", surface, Crs::parse("EPSG:25832+7837"));
  const std::string dsm = (folder_ / "dsm.tif").string(), dtm = write_terrain(0, 0).string();
  outline_options_.terrain = dtm;
  outline_options_.heights_from = dsm;
  build(town, "right");
  EXPECT_TRUE(warnings.empty()) << warnings.front();
  std::swap(outline_options_.terrain, outline_options_.heights_from);
  build(town, "wrong");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("dsm.tif lies higher than " + dtm + " at 5 of 5 buildings: were --terrain and --heights-from given the wrong way round"), std::string::npos) << warnings[0];
}

TEST_F(OutlinePrior, AssumedHeightsAreTransformed) {
  options_.crs = "EPSG:25832+5773";
  EXPECT_THROW(build({box("a", 0, 0, 20, 20)}), CrsError) << "heights of unknown datum where one is asked";
  EXPECT_FALSE(fs::exists(folder_ / "prior"));
  options_.assume_vertical = "EPSG:5773";
  outline_options_.ground_height_m = 480;
  EXPECT_EQ(build({box("a", 0, 0, 20, 20)}).manifest.min.z(), 480);
}

TEST_F(OutlinePrior, HeightsFromASurfaceModelIgnoreTheTreesOverIt) {
  outline_options_.terrain = write_terrain(0, 0).string();
  HeightGrid surface{east - 50, north + 150, 1, 200, 200, {}};
  for (std::size_t row = 0; row < surface.rows; ++row)
    for (std::size_t column = 0; column < surface.columns; ++column) {
      const Eigen::Vector2d p = surface.cell_centre(column, row) - Eigen::Vector2d(east, north);
      const bool roof = p.x() > 0 && p.x() < 20 && p.y() > 0 && p.y() < 10, tree = p.x() > 15 && p.x() < 25;
      surface.heights_m.push_back(tree ? 528.f : roof ? 511.f : 500.f);
    }
  write_geotiff(folder_ / "dsm.tif", surface, Crs::parse("EPSG:25832+7837"));
  outline_options_.heights_from = (folder_ / "dsm.tif").string();
  Footprint tagged = box("tagged", 0, 40, 10, 10);
  tagged.attributes.height_m = 5;
  const OutlineReport report = build({box("a", 0, 0, 20, 10), tagged, box("bare", -40, 40, 10, 10)});
  EXPECT_EQ(report.counts.by_rule, (std::array<std::size_t, 4>{1, 1, 0, 1})) << "no building shows where the surface is the ground";
  EXPECT_NEAR(PriorStore(folder_ / "prior").features()[0].height_m, 11, 0.01);
}

TEST_F(OutlinePrior, ASurfaceNeedsAGround) {
  outline_options_.heights_from = write_terrain(0, 0).string();
  EXPECT_THROW(build({box("a", 0, 0, 20, 20)}), UsageError);
}

TEST_F(OutlinePrior, AllFacesIncludeFloorsAndSharedWalls) {
  const std::vector<Footprint> row{box("a", 0, 0, 10, 10), box("b", 10, 0, 10, 10)};
  build(row);
  outline_options_.faces = "all";
  build(row, "all");
  const auto visible = points(), all = points("all");
  std::vector<Eigen::Vector3d> missing;
  const auto less = [](const auto& a, const auto& b) { return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end()); };
  std::ranges::set_difference(visible, all, std::back_inserter(missing), less);
  EXPECT_TRUE(missing.empty());
  EXPECT_EQ(std::ranges::count_if(all, [](const auto& p) { return p.z() == 0; }), 41 * 21 + 21) << "both floors, the line under the shared wall twice";
  EXPECT_GT(all.size(), visible.size() + 2 * 19 * 15);
}

std::vector<Footprint> random_town(int n) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0, 600), size(4, 40), height(3, 30), unit(0, 1);
  std::vector<Footprint> town;
  for (int i = 0; i < n; ++i) {
    Footprint footprint;
    footprint.id = "b" + std::to_string(i);
    const double x = 690000 + place(random), y = 5340000 + place(random), angle = 6 * unit(random), w = size(random), d = size(random);
    for (const auto& [u, v] : {std::pair(0.0, 0.0), {w, 0.0}, {w, d}, {0.0, d}})
      footprint.rings.resize(1), footprint.rings[0].emplace_back(x + u * std::cos(angle) - v * std::sin(angle), y + u * std::sin(angle) + v * std::cos(angle));
    if (unit(random) < 0.5) footprint.attributes.height_m = height(random);
    if (unit(random) < 0.5) footprint.attributes.roof_shape = RoofShape(static_cast<int>(12 * unit(random)));
    town.push_back(std::move(footprint));
  }
  return town;
}

std::string bytes_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::ranges::sort(files);
  std::string all;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    all += fs::relative(file, folder).string() + '\n' + std::string(std::istreambuf_iterator<char>(in), {});
  }
  return all;
}

TEST_F(OutlinePrior, SameBytesForAnyNumberOfThreadsAndAnyOrder) {
  std::vector<Footprint> town = random_town(90);
  build(town, "one", 1);
  build(town, "three", 3);
  std::ranges::reverse(town);
  build(town, "reversed", 2);
  EXPECT_EQ(bytes_of(folder_ / "one"), bytes_of(folder_ / "three"));
  EXPECT_EQ(bytes_of(folder_ / "one"), bytes_of(folder_ / "reversed"));
}

TEST_F(OutlinePrior, BoxesShareNoPointAndLoseNone) {
  const std::vector<Footprint> town = random_town(60);
  build(town);
  options_.bbox_crs = "EPSG:25832";
  options_.bbox = {0, 0, east + 250, 1e7};
  options_.tile_size_m = 50;
  build(town, "west");
  options_.bbox = {east + 250, 0, 1e6, 1e7};
  options_.tile_size_m = 333;
  build(town, "east");
  std::vector<Eigen::Vector3d> both = points("west");
  std::ranges::copy(points("east"), std::back_inserter(both));
  std::ranges::sort(both, [](const auto& a, const auto& b) { return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end()); });
  EXPECT_EQ(both, points());
}

TEST_F(OutlinePrior, NothingToBuildIsAnErrorAndLeavesNothing) {
  EXPECT_THROW(build({}), FormatError);
  EXPECT_THROW(build({box("a", 0, 0, 0, 5)}), FormatError);
  options_.bbox = {0, 0, 1, 1};
  EXPECT_THROW(build({box("a", 0, 0, 5, 5)}), FormatError);
  EXPECT_FALSE(fs::exists(folder_ / "prior"));
}

TEST_F(OutlinePrior, AFileGeodatabaseIsOneInputAndOtherFoldersAreNone) {
  const auto geodatabase = [&](const std::string& name, const std::string& table) {
    fs::create_directories(folder_ / name);
    std::ofstream(folder_ / name / "a00000001.gdbtable") << table;
    return folder_ / name;
  };
  const fs::path town = geodatabase("town.gdb", "houses"), copy = geodatabase("copy.gdb", "houses"), other = geodatabase("other.gdb", "huts");
  EXPECT_EQ(distinct_files({town, copy, other}).size(), 2u);
  const std::string hash = distinct_files({town})[0].sha256;
  std::ofstream(town / "_gdb.host.lock") << "a reader was here";
  const HashedFile with_slash = distinct_files({town / ""})[0];
  EXPECT_EQ(with_slash.sha256, hash);
  EXPECT_EQ(with_slash.path.filename(), "town.gdb");
  EXPECT_THROW(distinct_files({folder_}), IoError);
  EXPECT_EQ(distinct_files({"/vsizip/town.zip/town.shp"}).size(), 1u) << "GDAL finds it, or says that it does not";
}

}  // namespace
}  // namespace priormap
