#pragma once
#include <algorithm>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {

/// Loads tiles by a thread of its own before they are needed.
template <class Tile>
class TilePrefetch {
 public:
  /// @param load  thread-safe
  explicit TilePrefetch(std::function<Tile(TileKey)> load) : load_(std::move(load)), thread_([this] { run(); }) {}
  ~TilePrefetch() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  TilePrefetch(const TilePrefetch&) = delete;
  TilePrefetch& operator=(const TilePrefetch&) = delete;

  /// What will be needed; loaded in this order. What was wished before and is not any more is forgotten.
  void wish(const std::vector<TileKey>& keys) {
    {
      const std::lock_guard lock(mutex_);
      std::erase_if(slots_, [&](const Slot& slot) { return slot.state != State::loading && std::find(keys.begin(), keys.end(), slot.key) == keys.end(); });
      for (const TileKey key : keys)
        if (!find(key)) slots_.push_back({key, State::waiting, std::nullopt});
    }
    changed_.notify_all();
  }

  /// The tile, if it is ready or being loaded; none if it was not begun, or failed: load it oneself, and see why.
  std::optional<Tile> take(TileKey key) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !find(key) || find(key)->state != State::loading; });
    Slot* slot = find(key);
    if (!slot) return std::nullopt;
    std::optional<Tile> tile = std::move(slot->tile);
    std::erase_if(slots_, [&](const Slot& s) { return s.key == key; });
    return tile;
  }

 private:
  enum class State { waiting, loading, done };
  struct Slot {
    TileKey key;
    State state;
    std::optional<Tile> tile;
  };

  Slot* find(TileKey key) {
    const auto slot = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) { return s.key == key; });
    return slot == slots_.end() ? nullptr : &*slot;
  }
  auto first_waiting() {
    return std::find_if(slots_.begin(), slots_.end(), [](const Slot& s) { return s.state == State::waiting; });
  }

  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return stopped_ || first_waiting() != slots_.end(); });
      if (stopped_) return;
      const auto next = first_waiting();
      const TileKey key = next->key;
      next->state = State::loading;
      lock.unlock();
      std::optional<Tile> tile;
      try {
        tile = load_(key);
      } catch (...) {   // who needs the tile meets the cause again
      }
      lock.lock();
      Slot& slot = *find(key);
      slot.state = State::done;
      slot.tile = std::move(tile);
      changed_.notify_all();
    }
  }

  std::function<Tile(TileKey)> load_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Slot> slots_;
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace priormap
