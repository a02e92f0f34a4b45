#include <priormap/prior/tile_index.hpp>

#include <algorithm>
#include <set>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>

#include "test_prior.hpp"

namespace priormap {
namespace {

std::vector<TileEntry> scattered_entries(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int32_t> index(-40, 40);
  std::set<TileKey> keys;
  while (keys.size() < n) keys.insert({index(random), index(random)});
  std::vector<TileEntry> entries;
  for (const TileKey key : keys) {
    Sha256 hash;
    hash.update(TileGrid::name(key));
    entries.push_back({key, std::uint64_t(key.x * key.x + 1), float(key.y), float(key.y) + 10, 4711, hash.hex_digest()});
  }
  return entries;
}

TEST(TileIndex, RowsComeBackAsWritten) {
  const TestFolder folder;
  const std::vector<TileEntry> written = scattered_entries(3000, 1);   // three pages
  const TileIndexDigest digest = write_tile_index(folder / "tiles.idx", written);
  const TileIndex index(folder / "tiles.idx", digest.head_sha256);
  ASSERT_EQ(index.size(), written.size());
  std::size_t i = 0;
  for (const TileEntry entry : index.entries()) {
    EXPECT_EQ(entry.key, written[i].key);
    EXPECT_EQ(entry.num_points, written[i].num_points);
    EXPECT_EQ(entry.min_z, written[i].min_z);
    EXPECT_EQ(entry.max_z, written[i].max_z);
    EXPECT_EQ(entry.num_bytes, written[i].num_bytes);
    EXPECT_EQ(entry.sha256, written[i].sha256);
    ++i;
  }
  EXPECT_EQ(digest.file_sha256, sha256_file(folder / "tiles.idx"));
}

TEST(TileIndex, FindsExactlyTheTilesThatAreThere) {
  const TestFolder folder;
  const std::vector<TileEntry> written = scattered_entries(500, 2);
  const TileIndex index(folder / "tiles.idx", write_tile_index(folder / "tiles.idx", written).head_sha256);
  for (std::int32_t x = -42; x <= 42; ++x)
    for (std::int32_t y = -42; y <= 42; ++y) {
      const bool expected = std::ranges::any_of(written, [&](const TileEntry& e) { return e.key == TileKey{x, y}; });
      EXPECT_EQ(index.find({x, y}).has_value(), expected);
    }
}

TEST(TileIndex, KeysWithinAgreeWithALinearSearch) {
  const TestFolder folder;
  const std::vector<TileEntry> written = scattered_entries(2500, 3);
  const TileIndex index(folder / "tiles.idx", write_tile_index(folder / "tiles.idx", written).head_sha256);
  std::mt19937 random(4);
  std::uniform_int_distribution<std::int32_t> corner(-45, 45);
  for (int round = 0; round < 300; ++round) {
    TileKey low{corner(random), corner(random)}, high{corner(random), corner(random)};
    if (round == 0) low = {INT32_MIN, INT32_MIN}, high = {INT32_MAX, INT32_MAX};
    std::vector<TileKey> expected;
    for (const TileEntry& e : written)
      if (e.key.x >= low.x && e.key.x <= high.x && e.key.y >= low.y && e.key.y <= high.y) expected.push_back(e.key);
    EXPECT_EQ(index.keys_within(low, high), expected);
  }
}

TEST(TileIndex, AnEmptyIndexHasNoTiles) {
  const TestFolder folder;
  const TileIndex index(folder / "tiles.idx", write_tile_index(folder / "tiles.idx", {}).head_sha256);
  EXPECT_EQ(index.size(), 0u);
  EXPECT_FALSE(index.find({0, 0}));
  EXPECT_TRUE(index.keys_within({INT32_MIN, INT32_MIN}, {INT32_MAX, INT32_MAX}).empty());
}

TEST(TileIndex, EveryCutIsNoticed) {
  const TestFolder folder;
  const TileIndexDigest digest = write_tile_index(folder / "tiles.idx", scattered_entries(40, 5));
  const std::string whole = file_text(folder / "tiles.idx");
  for (std::size_t size = 0; size < whole.size(); size += 13) {
    std::ofstream(folder / "cut.idx", std::ios::binary) << whole.substr(0, size);
    EXPECT_THROW(TileIndex(folder / "cut.idx", digest.head_sha256), FormatError) << size;
  }
}

TEST(TileIndex, EveryChangedByteIsNoticedWhenItsRowIsRead) {
  const TestFolder folder;
  const TileIndexDigest digest = write_tile_index(folder / "tiles.idx", scattered_entries(40, 6));
  const std::string whole = file_text(folder / "tiles.idx");
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string changed = whole;
    changed[at] = char(changed[at] ^ 0x10);
    std::ofstream(folder / "changed.idx", std::ios::binary) << changed;
    EXPECT_THROW(TileIndex(folder / "changed.idx", digest.head_sha256).entry(0), FormatError) << at;
  }
}

}  // namespace
}  // namespace priormap
