#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/tessellation/roof.hpp>

namespace priormap {

/// One block of a building in the prior's CRS: an outline between its lowest wall edge and its roof.
struct BuildingSolid {
  Polygon2 outline;           ///< normalized
  double base_z = 0;          ///< walls start here
  double eaves_z = 0;
  double top_z = 0;
  RoofSpec roof_spec;         ///< its rise is top_z - eaves_z
  std::optional<Roof> roof;   ///< none: flat at top_z
  bool on_ground = true;      ///< nothing can be seen below base_z
  bool has_walls = true;
  std::uint32_t feature = 0;  ///< whatever the caller numbers
  Bounds2 bounds;             ///< of the outline, closed

  std::vector<Face> faces(bool with_underside) const;
  /// Height of the roof over a place inside the outline; of an overhanging one the highest.
  double roof_z(const Eigen::Vector2d& place) const;
  /// Inside or on the skin, by `tolerance_m` vertically.
  bool holds(const Eigen::Vector3d& point, double tolerance_m) const;
};

Bounds2 bounds_of(const Ring2& ring);

}  // namespace priormap
