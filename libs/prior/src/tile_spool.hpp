#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>

#include "point_record.hpp"
#include <priormap/core/spill_file.hpp>

namespace priormap {

/// Points collected per tile with bounded memory: in memory up to a bound, beyond it appended to one spill file of which
/// each tile remembers its pieces. Thread-safe.
class TileSpool {
 public:
  TileSpool(std::filesystem::path folder, std::size_t memory_bytes) : spill_(std::move(folder)), memory_bytes_(memory_bytes) {}

  void add(TileKey key, std::span<const PointRecord> points);
  /// Keys of all tiles that hold points, sorted.
  std::vector<TileKey> keys() const;
  /// How many points a tile holds.
  std::size_t count(TileKey key) const;
  /// All points of a tile, in no particular order; the spool forgets them. @throws IoError
  std::vector<PointRecord> take(TileKey key);
  /// Gives memory back that `take` or `spare` gave away, for tiles to come: new memory costs as much as what is done with it.
  void recycle(std::vector<PointRecord> points);
  /// Without points; with the room that a former tile needed, where one is left.
  std::vector<PointRecord> spare();

 private:
  /// Points as they are, or as runs where that takes less room; in a few chunks, which are not copied when more come.
  struct Tile {
    std::size_t count = 0;
    std::vector<PointRecord> points;
    std::vector<std::vector<std::byte>> runs;
    std::vector<SpillFile::Piece> spilled_points, spilled_runs;

    std::size_t bytes() const;
  };
  struct KeyHash {
    std::size_t operator()(TileKey key) const {
      return (std::uint64_t(std::uint32_t(key.x)) << 32 | std::uint32_t(key.y)) * 0x9e3779b97f4a7c15u >> 20;
    }
  };
  struct Shard {
    mutable std::mutex mutex;
    std::unordered_map<TileKey, Tile, KeyHash> tiles;
  };
  Shard& shard(TileKey key) { return shards_[KeyHash{}(key) % shards_.size()]; }
  const Shard& shard(TileKey key) const { return shards_[KeyHash{}(key) % shards_.size()]; }
  void spill();

  std::array<Shard, 64> shards_;
  SpillFile spill_;
  std::mutex spill_mutex_;
  std::size_t next_to_spill_ = 0;   ///< of the shards
  std::mutex spares_mutex_;
  std::vector<std::vector<PointRecord>> spares_;
  std::atomic<std::size_t> used_bytes_ = 0;
  std::size_t memory_bytes_;
};

}  // namespace priormap
