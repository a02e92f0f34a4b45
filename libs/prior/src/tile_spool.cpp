#include "tile_spool.hpp"

#include <algorithm>
#include <utility>

#include "point_runs.hpp"

namespace priormap {
namespace {

/// The chunk that takes so many bytes more.
std::vector<std::byte>& chunk_for(std::size_t bytes, std::vector<std::vector<std::byte>>& chunks) {
  constexpr std::size_t usual = std::size_t(1) << 16;   // the first one grows up to it: most tiles of a sparse prior need little
  if (chunks.empty()) return chunks.emplace_back();
  const std::size_t room = chunks.back().capacity() - chunks.back().size();
  if (room < bytes && chunks.back().capacity() >= usual) chunks.emplace_back().reserve(std::max(usual, bytes));
  return chunks.back();
}

}  // namespace

std::size_t TileSpool::Tile::bytes() const {
  std::size_t bytes = points.capacity() * sizeof(PointRecord);
  for (const auto& chunk : runs) bytes += chunk.capacity();
  return bytes;
}

void TileSpool::add(TileKey key, std::span<const PointRecord> points) {
  const std::optional<std::size_t> run_bytes = bytes_of_runs(points);
  Shard& owner = shard(key);
  {
    const std::lock_guard lock(owner.mutex);
    Tile& tile = owner.tiles[key];
    const std::size_t bytes_before = tile.bytes();
    tile.count += points.size();
    if (run_bytes) {
      append_runs(points, chunk_for(*run_bytes, tile.runs));
    } else {
      if (tile.points.capacity() == 0) tile.points = spare();
      tile.points.insert(tile.points.end(), points.begin(), points.end());
    }
    used_bytes_ += tile.bytes() - bytes_before;
  }
  if (used_bytes_ > memory_bytes_) spill();
}

void TileSpool::recycle(std::vector<PointRecord> points) {
  constexpr std::size_t most_spares = 4, largest = std::size_t(1) << 18;   // 32 MB
  if (points.capacity() == 0) return;
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
  constexpr std::size_t block_bytes = std::size_t(1) << 23;
  std::vector<std::byte> block;
  std::vector<std::pair<std::vector<SpillFile::Piece>*, std::size_t>> members;   // whose pieces, number of its bytes in the block
  const auto flush = [&] {
    SpillFile::Piece piece = spill_.append(block);
    for (auto [pieces, size] : members) {
      pieces->push_back({piece.offset, size});
      piece.offset += size;
    }
    block.clear();
    members.clear();
  };
  const auto add = [&](std::span<const std::byte> bytes, std::vector<SpillFile::Piece>& pieces) {
    if (bytes.empty()) return;
    block.insert(block.end(), bytes.begin(), bytes.end());
    members.emplace_back(&pieces, bytes.size());
    if (block.size() >= block_bytes) flush();
  };
  // Half of it: what is only a little too much need not go out as a whole.
  for (std::size_t visited = 0; visited < shards_.size() && used_bytes_ > memory_bytes_ / 2; ++visited) {
    Shard& owner = shards_[next_to_spill_++ % shards_.size()];
    const std::lock_guard lock(owner.mutex);
    for (auto& [key, tile] : owner.tiles) {
      used_bytes_ -= tile.bytes();
      const std::vector<PointRecord> points = std::exchange(tile.points, {});
      add(std::as_bytes(std::span(points)), tile.spilled_points);
      for (const auto& chunk : std::exchange(tile.runs, {})) add(chunk, tile.spilled_runs);
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

std::size_t TileSpool::count(TileKey key) const {
  const Shard& owner = shard(key);
  const std::lock_guard lock(owner.mutex);
  const auto found = owner.tiles.find(key);
  return found == owner.tiles.end() ? 0 : found->second.count;
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
  used_bytes_ -= tile.bytes();
  for (const SpillFile::Piece& piece : tile.spilled_runs) tile.runs.push_back(spill_.read(piece));
  std::size_t spilled = 0, most_in_runs = 0;
  for (const SpillFile::Piece& piece : tile.spilled_points) spilled += piece.size / sizeof(PointRecord);
  for (const auto& chunk : tile.runs) most_in_runs += most_points(chunk);

  std::vector<PointRecord> points = tile.points.capacity() > 0 ? std::move(tile.points) : spare();
  std::size_t count = points.size();
  points.reserve(count + spilled + most_in_runs);
  points.resize(count + spilled);
  for (const SpillFile::Piece& piece : tile.spilled_points) {
    spill_.read(piece, reinterpret_cast<std::byte*>(points.data() + count));
    count += piece.size / sizeof(PointRecord);
  }
  for (auto& chunk : tile.runs) append_points(std::exchange(chunk, {}), points);
  return points;
}

}  // namespace priormap
