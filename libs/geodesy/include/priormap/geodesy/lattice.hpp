#pragma once

namespace priormap {

/// A coordinate in thousandths of its unit, on which all points of a prior lie: the nearest whole one, halves upwards; not a number stays that. Exact up to 10^12
/// steps. Without branches and calls, for many at once.
inline double lattice_steps(double coordinate) {
  constexpr double rounding = 6755399441055744.0;   // 1.5 * 2^52: adding and taking it away rounds to the nearest, halves to even
  const double steps = coordinate * 1000, nearest = (steps + rounding) - rounding;
  return nearest + (steps - nearest == 0.5 ? 1.0 : 0.0);
}

}  // namespace priormap
