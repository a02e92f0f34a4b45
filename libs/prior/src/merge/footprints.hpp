#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <priormap/prior/feature.hpp>

#include "lattice.hpp"

namespace priormap {

/// Outlines on the lattice, found by tile. Inside is decided exactly and half-open: a point on the edge that two outlines share lies
/// in one of them.
class Footprints {
 public:
  /// @param margin  points up to this far outside their tile will be asked for
  Footprints(const LatticeGrid& grid, std::int64_t margin_steps) : grid_(grid), margin_(margin_steps) {}

  void add(const Feature& feature);

  /// Those that touch one tile, for many questions.
  class InTile {
   public:
    bool empty() const { return polygons_.empty(); }
    /// @param x, y  [lattice steps from the tile's lower-left corner]
    bool contains(std::int32_t x, std::int32_t y) const;

   private:
    friend class Footprints;
    struct Point {
      std::int64_t x, y;
    };
    struct Polygon {
      Point min, max;
      std::vector<std::vector<Point>> rings;
    };
    std::vector<Polygon> polygons_;
  };
  InTile in_tile(TileKey key) const;

 private:
  struct KeyHash {
    std::size_t operator()(TileKey key) const {
      return (std::uint64_t(std::uint32_t(key.x)) << 32 | std::uint32_t(key.y)) * 0x9e3779b97f4a7c15u >> 20;
    }
  };
  LatticeGrid grid_;
  std::int64_t margin_;
  std::vector<InTile::Polygon> polygons_;
  std::unordered_map<TileKey, std::vector<std::uint32_t>, KeyHash> polygons_of_tile_;
};

}  // namespace priormap
