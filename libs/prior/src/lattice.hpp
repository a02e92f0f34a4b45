#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/lattice.hpp>
#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {

constexpr double lattice_step = 0.001;   ///< [CRS units]

/// A coordinate on the lattice of a CRS.
/// @throws Error when it is no number or beyond 10^9 units.
inline std::int64_t to_lattice(double value) {
  const double steps = lattice_steps(value);
  if (!(std::abs(steps) < 1e12)) throw Error("a point of the prior has a coordinate that is no number or out of range");
  return static_cast<std::int64_t>(steps);
}

inline std::int32_t to_height_mm(double z) {
  const std::int64_t mm = to_lattice(z);
  if (mm != static_cast<std::int32_t>(mm)) throw Error("a point of the prior has a height beyond 2000 km");
  return static_cast<std::int32_t>(mm);
}

/// The tile grid in whole lattice steps, where half-open tiles are exact.
class LatticeGrid {
 public:
  static constexpr double min_tile_size = 1, max_tile_size = 5000;

  /// @throws UsageError when the size is outside [1, 5000] or no whole number of steps.
  explicit LatticeGrid(double tile_size) : step_(std::llround(tile_size * 1000.0)) {
    if (!(tile_size >= min_tile_size && tile_size <= max_tile_size) || std::abs(tile_size * 1000.0 - double(step_)) > 1e-6)
      throw UsageError("tile size " + std::to_string(tile_size) + " is not a whole number of millimetres between 1 m and 5000 m");
  }
  std::int64_t tile_steps() const { return step_; }
  std::int64_t origin(std::int32_t index) const { return index * step_; }
  std::int32_t index(std::int64_t coordinate) const {
    const std::int64_t quotient = coordinate / step_;
    return static_cast<std::int32_t>(coordinate % step_ < 0 ? quotient - 1 : quotient);
  }
  TileKey key(std::int64_t x, std::int64_t y) const { return {index(x), index(y)}; }

 private:
  std::int64_t step_;
};

}  // namespace priormap
