#pragma once

namespace priormap {

/// Whether a surface stands as a wall does, within 17 degrees of upright; what lies flatter is roof, ground or underside. @param normal_z  of its unit normal
constexpr bool is_wall(double normal_z) {
  constexpr double greatest = 0.3;
  return -greatest < normal_z && normal_z < greatest;
}

}  // namespace priormap
