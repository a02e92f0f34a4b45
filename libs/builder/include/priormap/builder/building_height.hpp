#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include <priormap/builder/outline_options.hpp>
#include <priormap/sources/footprint.hpp>
#include <priormap/tessellation/roof.hpp>

namespace priormap {

/// Where a building's height comes from, in order of preference.
enum class HeightRule : std::uint8_t { tag, dsm, levels, fallback };
inline constexpr int num_height_rules = 4;
std::string to_string(HeightRule rule);   ///< "tag", "dsm", "levels", "default"

/// Standard deviation of a roof whose height the rule gave [m].
double height_sigma_m(HeightRule rule, const OutlineOptions& options);

/// Heights above the ground.
struct BuildingHeight {
  double top_m = 0;     ///< roof included
  double eaves_m = 0;   ///< where the roof starts
  double bottom_m = 0;  ///< where the walls start: above 0 for what stands on pillars or on a lower part
  HeightRule rule = HeightRule::fallback;
};

/// Height by tag, else by `surface_m`, else levels (and roof levels) times the storey height, else the default. The roof's share comes from its height, angle
/// or levels; where only its shape is known it climbs at 30 degrees (skillion: 10) by one storey at most, and never more than half of a height by default.
/// A surface model under a pitched roof says 70 % of the rise, not its top.
/// @param surface_m  70th percentile of the surface inside the outline above the ground; none: not known
/// @param run_m      horizontal distance over which the roof climbs (roof_run_m)
BuildingHeight building_height(const BuildingAttributes& attributes, std::optional<double> surface_m, double run_m, const OutlineOptions& options);

}  // namespace priormap
