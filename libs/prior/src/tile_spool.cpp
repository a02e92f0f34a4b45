#include "tile_spool.hpp"

#include <algorithm>

namespace priormap {

void TileSpool::add(TileKey key, std::span<const PointRecord> points) {
  Shard& owner = shard(key);
  {
    const std::lock_guard lock(owner.mutex);
    const auto [found, is_new] = owner.tiles.try_emplace(key);
    std::vector<PointRecord>& collected = found->second.points;
    const std::size_t capacity_before = collected.capacity();
    if (is_new) collected = spare();
    collected.insert(collected.end(), points.begin(), points.end());
    used_bytes_ += (collected.capacity() - capacity_before) * sizeof(PointRecord);
  }
  if (used_bytes_ > memory_bytes_) spill();
}

void TileSpool::recycle(std::vector<PointRecord>&& points) {
  constexpr std::size_t most_spares = 4, largest = std::size_t(1) << 18;   // 32 MB
  points.clear();
  const std::lock_guard lock(spares_mutex_);
  if (spares_.size() < most_spares && points.capacity() <= largest) spares_.push_back(std::move(points));
}

std::vector<PointRecord> TileSpool::spare() {
  const std::lock_guard lock(spares_mutex_);
  if (spares_.empty()) return {};
  std::vector<PointRecord> points = std::move(spares_.back());
  spares_.pop_back();
  return points;
}

void TileSpool::spill() {
  const std::lock_guard one_at_a_time(spill_mutex_);
  if (used_bytes_ <= memory_bytes_) return;
  constexpr std::size_t block_records = std::size_t(1) << 18;
  std::vector<PointRecord> block;
  std::vector<std::pair<Tile*, std::size_t>> members;   // tile, number of its records in the block
  auto flush = [&] {
    SpillFile::Piece piece = spill_.append(std::as_bytes(std::span(block)));
    for (auto [tile, count] : members) {
      tile->pieces.push_back({piece.offset, count * sizeof(PointRecord)});
      piece.offset += count * sizeof(PointRecord);
    }
    block.clear();
    members.clear();
  };
  // Half of it: what is only a little too much need not go out as a whole.
  for (std::size_t visited = 0; visited < shards_.size() && used_bytes_ > memory_bytes_ / 2; ++visited) {
    Shard& owner = shards_[next_to_spill_++ % shards_.size()];
    const std::lock_guard lock(owner.mutex);
    for (auto& [key, tile] : owner.tiles) {
      if (tile.points.empty()) continue;
      block.insert(block.end(), tile.points.begin(), tile.points.end());
      members.emplace_back(&tile, tile.points.size());
      used_bytes_ -= tile.points.capacity() * sizeof(PointRecord);
      std::vector<PointRecord>().swap(tile.points);
      if (block.size() >= block_records) flush();
    }
    if (!block.empty()) flush();
  }
}

std::vector<TileKey> TileSpool::keys() const {
  std::vector<TileKey> keys;
  for (const Shard& owner : shards_) {
    const std::lock_guard lock(owner.mutex);
    for (const auto& [key, tile] : owner.tiles) keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::vector<PointRecord> TileSpool::take(TileKey key) {
  Tile tile;
  {
    Shard& owner = shard(key);
    const std::lock_guard lock(owner.mutex);
    const auto found = owner.tiles.find(key);
    if (found == owner.tiles.end()) return {};
    tile = std::move(found->second);
    owner.tiles.erase(found);
  }
  used_bytes_ -= tile.points.capacity() * sizeof(PointRecord);
  std::size_t count = tile.points.size();
  std::size_t spilled = 0;
  for (const SpillFile::Piece& piece : tile.pieces) spilled += piece.size / sizeof(PointRecord);
  tile.points.resize(count + spilled);
  for (const SpillFile::Piece& piece : tile.pieces) {
    spill_.read(piece, reinterpret_cast<std::byte*>(tile.points.data() + count));
    count += piece.size / sizeof(PointRecord);
  }
  return std::move(tile.points);
}

}  // namespace priormap
