#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {

/// One row of tiles.idx.
struct TileEntry {
  TileKey key;
  std::uint64_t num_points = 0;
  float min_z = 0, max_z = 0;            ///< of the points [m]
  std::uint64_t num_bytes = 0;           ///< of the tile file
  std::string sha256;                    ///< of the tile file
};

/// Digests of a tiles.idx, as prior.json states them.
struct TileIndexDigest {
  std::string file_sha256;   ///< of the whole file
  std::string head_sha256;   ///< of its head, which holds the digest of every page: enough to trust any page
};

/// The table of tiles, a sorted file mapped into memory: opening reads the head only (0.5 KB per 16,000 tiles), each page of rows
/// is checked against the head when it is first touched. Layout in docs/file-formats.md. Const members are thread-safe.
class TileIndex {
 public:
  /// @throws IoError, FormatError when the file is no index, is cut, or its head's digest is not `head_sha256`.
  TileIndex(const std::filesystem::path& file, const std::string& head_sha256);
  ~TileIndex();
  TileIndex(TileIndex&&) noexcept;
  TileIndex& operator=(TileIndex&&) noexcept;

  std::size_t size() const;
  /// Row `i` in order of key (x, then y). @throws FormatError when its page does not have the digest the head states.
  TileEntry entry(std::size_t i) const;
  std::optional<TileEntry> find(TileKey key) const;
  /// All rows, read on demand.
  auto entries() const {
    return std::views::iota(std::size_t(0), size()) | std::views::transform([this](std::size_t i) { return entry(i); });
  }
  /// Keys of the rows with x in [low.x, high.x] and y in [low.y, high.y], sorted.
  std::vector<TileKey> keys_within(TileKey low, TileKey high) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes tiles.idx; `entries` sorted by key. @throws IoError
TileIndexDigest write_tile_index(const std::filesystem::path& file, std::span<const TileEntry> entries);

}  // namespace priormap
