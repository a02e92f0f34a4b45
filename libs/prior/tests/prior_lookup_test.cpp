#include <priormap/prior/prior_lookup.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <thread>

#include <priormap/core/error.hpp>

#include "test_prior.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

const Bounds2 everywhere{-1e9, -1e9, 1e9, 1e9};

fs::path write_prior(const fs::path& directory, double tile_size, unsigned seed = 1) {
  PriorWriter writer(directory, test_manifest({test_source("a")}, tile_size), Overwrite::refuse);
  writer.add(random_cloud(3000, seed, 260, {691'000, 5'336'000, 0}));
  writer.add(random_cloud(500, seed + 1, 100, {-50, -70, -20}));
  writer.finish(2);
  return directory;
}

using Millimetres = std::array<std::int64_t, 3>;

Millimetres millimetres(const Eigen::Vector3d& p) { return {std::llround(1000 * p.x()), std::llround(1000 * p.y()), std::llround(1000 * p.z())}; }

std::vector<Millimetres> points_of_tiles(const PriorStore& store) {
  std::vector<Millimetres> points;
  for (const TileEntry entry : store.tiles()) {
    const PointCloud tile = store.load(entry.key).points;
    for (std::size_t i = 0; i < tile.size(); ++i) points.push_back(millimetres(tile.position(i)));
  }
  std::sort(points.begin(), points.end());
  return points;
}

std::vector<Millimetres> points_of_lookup(const PriorLookup& lookup) {
  std::vector<Millimetres> points;
  for (const TileKey cell : lookup.cells_within(everywhere)) {
    const PointCloud cloud = lookup.points(cell);
    for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(millimetres(cloud.position(i)));
  }
  std::sort(points.begin(), points.end());
  return points;
}

/// All that a lookup gives, as bytes.
std::string content(const PriorLookup& lookup) {
  std::string bytes;
  const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  for (const TileKey cell : lookup.cells_within(everywhere)) {
    const PatchCloud patches = lookup.patches(cell);
    for (int a = 0; a < 3; ++a) append(patches.origin[a]);
    for (const SurfacePatch& p : patches.patches) append(p);
    for (const Eigen::Vector3f& p : lookup.points(cell).xyz) append(p);
  }
  return bytes;
}

void flip_byte(const fs::path& file, std::size_t at) {
  std::string text = file_text(file);
  ASSERT_LT(at, text.size());
  text[at] = char(text[at] ^ 1);
  std::ofstream(file, std::ios::binary) << text;
}

TEST(PriorLookup, CellsHoldThePointsOfTheTilesToTheMillimetre) {
  for (const double tile_size : {50.0, 200.0, 133.333}) {
    const TestFolder folder;
    const PriorStore store(write_prior(folder / "prior", tile_size));
    EXPECT_EQ(points_of_lookup(PriorLookup(store, {})), points_of_tiles(store)) << tile_size;
  }
}

TEST(PriorLookup, CellsWithinAreThoseThatTouchTheBounds) {
  const TestFolder folder;
  const PriorStore store(write_prior(folder / "prior", 200));
  const PriorLookup lookup(store, {});
  const std::vector<TileKey> cells = lookup.cells_within({691'060, 5'336'010, 691'120, 5'336'040});
  const std::vector<TileKey> expected = {{13821, 106720}, {13822, 106720}};   // of 50 m
  EXPECT_EQ(cells, expected);
  EXPECT_EQ(lookup.grid().tile_of({13821, 106720}), (TileKey{3455, 26680}));
  EXPECT_EQ(lookup.grid().tile_of({-1, -4}), (TileKey{-1, -1}));
  EXPECT_EQ(lookup.grid().tile_of({-5, 4}), (TileKey{-2, 1}));
}

TEST(PriorLookup, PatchesAreThoseOfTheCellsPoints) {
  const TestFolder folder;
  const PriorStore store(write_prior(folder / "prior", 100));
  const PriorLookup lookup(store, {});
  std::size_t num_patches = 0;
  for (const TileKey cell : lookup.cells_within(everywhere)) {
    const Bounds2 bounds = lookup.grid().as_tiles().bounds(cell);
    const PointCloud tile = store.load(lookup.grid().tile_of(cell)).points;
    std::vector<std::uint32_t> inside;
    for (std::uint32_t i = 0; i < tile.size(); ++i)
      if (bounds.contains(std::round(1000 * tile.position(i).x()) / 1000, std::round(1000 * tile.position(i).y()) / 1000)) inside.push_back(i);
    const PatchCloud patches = lookup.patches(cell);
    PointCloud points = tile.select(inside);
    if (!points.empty()) points.set_origin(patches.origin);
    const PatchCloud expected = patches_of_cell(points, {});
    ASSERT_EQ(patches.size(), expected.size());
    for (std::size_t i = 0; i < patches.size(); ++i) {
      ASSERT_LT((patches.patches[i].mean - expected.patches[i].mean).norm(), 1e-4);
      ASSERT_LT((patches.patches[i].normal - expected.patches[i].normal).norm(), 1e-4);
      ASSERT_EQ(patches.patches[i].count, expected.patches[i].count);
    }
    num_patches += patches.size();
  }
  EXPECT_GT(num_patches, 1000u);
}

TEST(PriorLookup, RoofsAreLeftOutWallsAndGroundAreNot) {
  PointCloud cell;
  const auto add = [&](float z, const Eigen::Vector3f& normal, PointClass kind) {
    for (int i = 0; i < 3; ++i) {
      cell.xyz.push_back({0.1f + 0.3f * float(i), 0.5f, z});
      cell.normal.push_back(normal);
      cell.classification.push_back(std::uint8_t(kind));
      cell.sigma_m.push_back(1);
    }
  };
  add(0.5f, {0, 0, 1}, PointClass::ground);
  add(1.5f, {0, 1, 0}, PointClass::building);
  add(2.5f, {0, 0, 1}, PointClass::building);
  add(3.5f, {0, 0.6f, 0.8f}, PointClass::building);
  add(4.5f, {0, 0, 1}, PointClass::unclassified);
  const PatchCloud patches = patches_of_cell(cell, {});
  ASSERT_EQ(patches.size(), 3u);
  EXPECT_NEAR(patches.patches[0].mean.z(), 0.5f, 1e-5f);
  EXPECT_NEAR(patches.patches[1].mean.z(), 1.5f, 1e-5f);
  EXPECT_NEAR(patches.patches[2].mean.z(), 4.5f, 1e-5f);
}

TEST(PriorLookup, PatchesAreInMetresWhateverTheUnit) {
  const TestFolder folder;
  PriorWriter writer(folder / "prior", test_manifest({test_source("a")}, 50), Overwrite::refuse);
  PointCloud pair;
  pair.xyz = {{1, 2, 10}, {21, 2, 30}};
  pair.source = {0, 0};
  writer.add(pair);
  writer.finish(1);
  const PriorStore store(folder / "prior");
  const PatchCloud feet = PriorLookup(store, {0.3048, 0.3048}).patches({0, 0});
  ASSERT_EQ(feet.size(), 2u);
  EXPECT_LT((feet.patches[1].mean - feet.patches[0].mean - Eigen::Vector3f(6.096f, 0, 6.096f)).norm(), 1e-5);
}

TEST(PriorLookup, IsTheSameFromTheFileAndWithoutOne) {
  const TestFolder folder;
  const PriorStore store(write_prior(folder / "prior", 100));
  const fs::path files = folder / "prior/lookup";
  std::ofstream(files.string()) << "no folder can be made here";
  const std::string in_memory = content(PriorLookup(store, {}));
  EXPECT_THROW(PriorLookup(store, {}).make_files(1), IoError);
  fs::remove(files);
  EXPECT_EQ(content(PriorLookup(store, {})), in_memory);   // writes
  const auto written = folder_content(files);
  EXPECT_EQ(written.size(), store.index().size());
  EXPECT_EQ(content(PriorLookup(store, {})), in_memory);   // reads
  EXPECT_EQ(PriorLookup(store, {}).make_files(2), 0u);
  fs::remove_all(files);
  EXPECT_EQ(PriorLookup(store, {}).make_files(2), store.index().size());
  EXPECT_EQ(folder_content(files), written);
}

TEST(PriorLookup, AFileOfAnotherTileOrPriorIsMadeAgain) {
  const TestFolder folder;
  const PriorStore store(write_prior(folder / "prior", 100)), other(write_prior(folder / "other", 100, 7));
  const std::string right = content(PriorLookup(store, {}));
  const auto files = folder_content(folder / "prior/lookup");
  PriorLookup(other, {}).make_files(1);
  fs::remove_all(folder / "prior/lookup");
  fs::copy(folder / "other/lookup", folder / "prior/lookup");
  EXPECT_EQ(content(PriorLookup(store, {})), right);
  EXPECT_EQ(folder_content(folder / "prior/lookup"), files);
  PriorLookup(store, {0.3048, 1}).make_files(1);   // units that another --assume-vertical gave
  EXPECT_EQ(content(PriorLookup(store, {})), right);
}

TEST(PriorLookup, AFlippedByteIsFoundAndMended) {
  const TestFolder folder;
  const PriorStore store(write_prior(folder / "prior", 300));
  const std::string right = content(PriorLookup(store, {}));
  const TileEntry entry = store.index().entry(store.index().size() - 1);
  const fs::path file = folder / "prior/lookup" / (TileGrid::name(entry.key) + ".cells");
  const std::string sound = file_text(file);
  for (std::size_t at = 0; at < sound.size(); at += at < 4000 ? 251 : sound.size() / 20) {
    flip_byte(file, at);
    ASSERT_EQ(content(PriorLookup(store, {})), right) << at;
    ASSERT_EQ(file_text(file), sound) << at;
  }
  for (const std::size_t length : {std::size_t(0), std::size_t(5), sound.size() / 2, sound.size() - 1}) {
    fs::resize_file(file, length);
    ASSERT_EQ(content(PriorLookup(store, {})), right) << length;
    ASSERT_EQ(file_text(file), sound) << length;
  }
  flip_byte(file, sound.size() - 1);
  EXPECT_EQ(PriorLookup(store, {}).make_files(1), 1u);
  EXPECT_EQ(file_text(file), sound);
}

TEST(PriorLookup, ADamagedTileIsAnErrorThatNamesIt) {
  const TestFolder folder;
  const PriorStore store(write_prior(folder / "prior", 100));
  const TileKey tile = store.index().entry(0).key;
  flip_byte(store.tile_file(tile), 1000);
  try {
    PriorLookup(store, {}).patches(PriorLookup(store, {}).grid().cell(tile, 0));
    FAIL() << "no error";
  } catch (const FormatError& error) {
    EXPECT_NE(std::string(error.what()).find(store.tile_file(tile).string()), std::string::npos) << error.what();
  }
}

TEST(PriorLookup, ATileThatIsGoneOrCutIsAnErrorThoughItsFileIsThere) {
  const TestFolder folder;
  const PriorStore store(write_prior(folder / "prior", 100));
  PriorLookup(store, {}).make_files(1);
  const TileKey tile = store.index().entry(0).key, cell = PriorLookup(store, {}).grid().cell(tile, 0);
  fs::resize_file(store.tile_file(tile), 1000);
  EXPECT_THROW(PriorLookup(store, {}).patches(cell), FormatError);
  fs::remove(store.tile_file(tile));
  EXPECT_THROW(PriorLookup(store, {}).patches(cell), IoError);
}

TEST(PriorLookup, ProgramsThatStartAtOnceGetTheSame) {
  const TestFolder folder;
  const PriorStore store(write_prior(folder / "prior", 50));
  const std::string right = content(PriorLookup(store, {}));
  const auto files = folder_content(folder / "prior/lookup");
  fs::remove_all(folder / "prior/lookup");
  std::vector<pid_t> children;
  for (int child = 0; child < 4; ++child) {
    const pid_t pid = ::fork();
    if (pid != 0) {
      children.push_back(pid);
      continue;
    }
    const PriorLookup lookup(store, {});
    bool same[2] = {false, false};
    std::thread other([&] { same[0] = content(lookup) == right; });
    same[1] = content(lookup) == right;
    other.join();
    ::_exit(same[0] && same[1] ? 0 : 1);
  }
  for (const pid_t pid : children) {
    int status = 0;
    ::waitpid(pid, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  EXPECT_EQ(folder_content(folder / "prior/lookup"), files);
}

}  // namespace
}  // namespace priormap
