#pragma once

namespace priormap {

/// Gaps between buildings that no beam enters, however they lie.
constexpr double touching_m = 0.05;
/// The same between walls that face each other in parallel. Each outline is drawn or rounded by a few centimetres of its own (OpenStreetMap keeps 1.1 cm), and joints between
/// houses are as wide; half a metre into such a gap a beam from outside meets the wall at 80 degrees.
constexpr double joint_m = 0.10;
/// Parallel: the sine of the angle between two walls.
constexpr double joint_sine = 0.1;   // 6 degrees

}  // namespace priormap
