#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include <priormap/geodesy/crs.hpp>

namespace priormap {

using Polyline2 = std::vector<Eigen::Vector2d>;

struct LineLayers {
  std::vector<Polyline2> lines;   ///< east before north, in `crs`; a point is a line of one vertex
  std::optional<Crs> crs;         ///< horizontal, of all layers; none: they declare none
};

/// Lines and points of any vector file that OGR reads, such as the GeoJSON track of a drive. Heights and polygons are not used; curves are replaced by chords.
/// @throws IoError, FormatError (no vector file, no line in it), CrsError when layers of the file differ in their CRS
LineLayers read_ogr_lines(const std::filesystem::path& file);

}  // namespace priormap
