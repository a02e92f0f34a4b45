#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <priormap/builder/bounds_index.hpp>
#include <priormap/builder/building_solid.hpp>

namespace priormap {

/// Which spots of a block's faces other blocks cover: walls that touching buildings share, roofs under a part that stands on them. A spot is hidden when the
/// space right in front of it lies inside another block, so that of two walls of different height only the upper strip of the higher one stays.
/// Const members are thread-safe.
class SolidIndex {
 public:
  explicit SolidIndex(std::span<const BuildingSolid> solids);

  /// Those of `solids` whose bounds come within a joint of the bounds of the solid, itself left out.
  std::vector<std::uint32_t> near(std::uint32_t solid) const;

  /// Removes the points of a face that one of `candidates` hides.
  /// @param normal  unit, outward
  void remove_hidden(const Face& face, const Eigen::Vector3d& normal, std::span<const std::uint32_t> candidates, std::vector<Eigen::Vector3d>& points) const;

 private:
  std::span<const BuildingSolid> solids_;
  BoundsIndex index_;
};

}  // namespace priormap
