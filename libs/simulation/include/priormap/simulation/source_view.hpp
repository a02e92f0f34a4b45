#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <priormap/core/option_field.hpp>
#include <priormap/geodesy/map_frame.hpp>
#include <priormap/simulation/town.hpp>
#include <priormap/simulation/world.hpp>
#include <priormap/sources/osm_writer.hpp>
#include <priormap/sources/raster_writer.hpp>

namespace priormap {

/// How the prior's sources differ from the truth.
struct SourceErrorOptions {
  double outline_sigma_m = 0.3;
  double outline_rotation_deg = 0.4;
  double missing_share = 0.1;
  double default_height_share = 0.6;
  double height_sigma_m = 0.5;
  double dsm_sigma_m = 0.08;
  double dsm_resolution_m = 1;
  double dsm_bias_m = 0;
  double dtm_sigma_m = 0.05;
  double shifted_block_m = 0;
  double gap_m = 0;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("outline-sigma", outline_sigma_m, {"error of the outlines' position, standard deviation per axis", "m", 0, 20});
    visit("outline-rotation", outline_rotation_deg, {"error of the outlines' direction, standard deviation", "deg", 0, 45});
    visit("missing-share", missing_share, {"share of the buildings that the OSM file lacks", "", 0, 1});
    visit("default-height-share", default_height_share, {"share of the buildings without height or levels (generated towns)", "", 0, 1});
    visit("height-sigma", height_sigma_m, {"error of the height tags, standard deviation (generated towns)", "m", 0, 20});
    visit("dsm-sigma", dsm_sigma_m, {"noise of the surface model, standard deviation", "m", 0, 20});
    visit("dsm-resolution", dsm_resolution_m, {"cell size of surface and terrain model", "m", 0.1, 100});
    visit("dsm-bias", dsm_bias_m, {"added to all heights of the surface model", "m", -50, 50});
    visit("dtm-sigma", dtm_sigma_m, {"noise of the terrain model, standard deviation", "m", 0, 20});
    visit("shifted-block", shifted_block_m, {"shift of all outlines within 80 m of the middle of the drive", "m", 0, 100});
    visit("prior-gap", gap_m, {"length of the drive, around its middle, that no source knows anything of", "m", 0, 1e6});
  }
};

/// What is wrong with one building in the OSM file.
struct BuildingError {
  bool missing = false;
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();   ///< of its centre
  double rotation = 0;                                 ///< about its centre, counter-clockwise
  bool has_height_tag = false, has_levels_tag = false;
  double height_error_m = 0;

  /// The outline as the source has it. `undo` takes a source outline back to the truth.
  Polygon2 apply(const Polygon2& truth) const;
  Polygon2 undo(const Polygon2& source) const;
};

/// Depends on the seed, the building's index and the options alone.
BuildingError draw_building_error(const SourceErrorOptions& options, std::uint64_t seed, std::size_t index);

/// Errors of all buildings of a town, the block and the gap along the drive included.
/// @param driven  line of the drive, frame `map`
std::vector<BuildingError> draw_errors(const Town& town, const std::vector<Eigen::Vector2d>& driven, const SourceErrorOptions& options,
                                       std::uint64_t seed);

/// OSM file of the town: buildings with their errors, streets, trees. Lon/lat are WGS 84.
OsmExtract osm_of(const Town& town, const std::vector<BuildingError>& errors, const MapFrame& frame);

/// Surface model and terrain model in the frame's projected CRS, NaN outside the town and in the gap.
HeightGrid surface_model(const World& world, const Town& town, const std::vector<Eigen::Vector2d>& driven, const MapFrame& frame,
                           const SourceErrorOptions& options, std::uint64_t seed);
HeightGrid terrain_model(const Town& town, const std::vector<Eigen::Vector2d>& driven, const MapFrame& frame,
                           const SourceErrorOptions& options, std::uint64_t seed);

}  // namespace priormap
