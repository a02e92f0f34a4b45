#pragma once
#include <optional>
#include <string>

#include <priormap/builder/sight_options.hpp>
#include <priormap/core/option_field.hpp>

namespace priormap {

/// How outlines become buildings: what osm2prior and footprints2prior ask alike.
struct OutlineOptions {
  double default_height_m = 8;
  double storey_height_m = 4;
  std::string terrain;                    ///< raster of the ground; empty: none
  std::optional<double> ground_height_m;  ///< ground where no terrain is known
  std::string heights_from;               ///< raster of the surface; empty: none
  std::string faces = "visible";          ///< or "all"
  double sigma_m = 1;              ///< of outlines, and with them of walls
  double height_sigma_m = 1;       ///< of roofs, by the rule that gave the height: tag or surface
  double levels_sigma_m = 2;
  double default_sigma_m = 4;
  SightOptions sight;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("default-height", default_height_m, {"height of a building that nothing else is known of", "m", 0.1, 1000});
    visit("storey-height", storey_height_m, {"height of a storey", "m", 0.5, 20});
    visit("terrain", terrain, {"raster of the ground under the buildings, such as DTM.tif"});
    visit("ground-height", ground_height_m, {"ground under the buildings where no terrain is known; default: 0", "m", -1000, 10000});
    visit("heights-from", heights_from, {"raster of the surface, such as DSM.tif: height of a building without a height tag, from the 70th percentile inside its outline"});
    visit("faces", faces, {"visible or all: visible leaves out walls that buildings share, undersides and floors"});
    visit("sigma", sigma_m, {"standard deviation of the outlines' positions", "m", 0.001, 65});
    visit("sigma-height", height_sigma_m, {"standard deviation of a roof whose height a tag, field or --heights-from gave", "m", 0.001, 65});
    visit("sigma-levels", levels_sigma_m, {"standard deviation of a roof whose height levels gave", "m", 0.001, 65});
    visit("sigma-default", default_sigma_m, {"standard deviation of a roof of default height", "m", 0.001, 65});
    sight.describe(visit);
  }

  bool visible_faces_only() const { return faces == "visible"; }
  /// @throws UsageError for faces that are neither visible nor all.
  void validate() const;
};

}  // namespace priormap
