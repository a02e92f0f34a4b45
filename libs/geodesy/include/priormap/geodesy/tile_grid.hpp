#pragma once
#include <cmath>
#include <compare>
#include <cstdint>
#include <string>

namespace priormap {

struct TileKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  auto operator<=>(const TileKey&) const = default;
};

/// A place on the lattice of 0.001 CRS units.
struct LatticePoint {
  std::int64_t x = 0, y = 0;
};

/// Half-open axis-aligned rectangle [min, max) in CRS units.
struct Bounds2 {
  double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  bool contains(double x, double y) const { return x >= min_x && x < max_x && y >= min_y && y < max_y; }
  bool empty() const { return !(min_x < max_x && min_y < max_y); }
};

/// Global half-open grid of square tiles in a projected CRS: tile (i, j) covers [i s, (i+1) s) x [j s, (j+1) s).
/// A point on an edge belongs to exactly one tile.
class TileGrid {
 public:
  explicit TileGrid(double tile_size) : size_(tile_size) {}
  double tile_size() const { return size_; }
  TileKey key(double x, double y) const { return {index(x), index(y)}; }
  Bounds2 bounds(TileKey key) const { return {key.x * size_, key.y * size_, (key.x + 1.0) * size_, (key.y + 1.0) * size_}; }
  static std::string name(TileKey key) { return std::to_string(key.x) + "_" + std::to_string(key.y); }

 private:
  /// floor(v / s), corrected so that the half-open bounds above hold exactly in double arithmetic.
  std::int32_t index(double v) const {
    auto i = static_cast<std::int32_t>(std::floor(v / size_));
    while (v < i * size_) --i;
    while (v >= (i + 1.0) * size_) ++i;
    return i;
  }
  double size_;
};

}  // namespace priormap
