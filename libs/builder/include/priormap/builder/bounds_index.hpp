#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {

/// Finds the rectangles that meet another, closed on all sides. Const members are thread-safe.
class BoundsIndex {
 public:
  void add(const Bounds2& bounds, std::uint32_t value);
  /// Once, after the last `add`.
  void sort();
  /// Values of the rectangles that meet `bounds`, ascending.
  std::vector<std::uint32_t> meeting(const Bounds2& bounds) const;

 private:
  using Cell = std::pair<std::int32_t, std::int32_t>;
  std::vector<Bounds2> bounds_;
  std::vector<std::uint32_t> values_;
  std::vector<std::pair<Cell, std::uint32_t>> entries_;   ///< of `bounds_`
};

inline Bounds2 grown(const Bounds2& b, double margin) { return {b.min_x - margin, b.min_y - margin, b.max_x + margin, b.max_y + margin}; }
inline bool meet(const Bounds2& a, const Bounds2& b) {
  return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y;
}

}  // namespace priormap
