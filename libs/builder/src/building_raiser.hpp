#pragma once
#include <optional>
#include <vector>

#include <priormap/builder/building_height.hpp>
#include <priormap/builder/building_parts.hpp>
#include <priormap/builder/building_solid.hpp>
#include <priormap/prior/feature.hpp>

#include "outline_crs.hpp"

namespace priormap {

/// One outline or part as it stands: its blocks, and what features.geojsonl says of it.
struct Building {
  std::vector<BuildingSolid> solids;   ///< empty: nothing stands there
  Feature feature;                     ///< without its source
  HeightRule rule = HeightRule::fallback;
  std::uint16_t file = 0;
  bool is_part = false;
  std::optional<double> surface_m;     ///< of a surface model above the ground, where one was asked
};

/// Lets parts replace outlines, finds ground and heights, builds roofs. One object per thread.
class BuildingRaiser {
 public:
  BuildingRaiser(const ProjectedFootprints& footprints, const PartAssignment& parts, const OutlineFrames& frames, const OutlineOptions& options)
      : footprints_(footprints), parts_(parts), ground_(frames.ground), surface_(frames.surface), surface_cell_m_(surface_ ? surface_->cell_size() : 0), options_(options) {}

  Building raise(std::uint32_t footprint, Diagnostics& diagnostics) const;

 private:
  /// Height of the surface model above the ground; nothing where the source says how high the building is.
  std::optional<double> surface_above(const ProjectedFootprint& own, const GroundModel::Under& ground) const;
  BuildingSolid solid(const Polygon2& outline, const BuildingAttributes& attributes, const GroundModel::Under& ground, const BuildingHeight& height,
                      const ProjectedFootprint& own, Diagnostics& diagnostics) const;
  Feature feature(const ProjectedFootprint& own, const GroundModel::Under& ground, const BuildingHeight& height) const;

  const ProjectedFootprints& footprints_;
  const PartAssignment& parts_;
  GroundModel ground_;
  std::optional<HeightRaster> surface_;
  double surface_cell_m_;
  const OutlineOptions& options_;
};

}  // namespace priormap
