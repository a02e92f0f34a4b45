#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include <priormap/geodesy/crs.hpp>

namespace priormap {

/// Places every 2 m along the streets of an OSM file, or along the lines and points of any other vector file, in the prior's CRS.
/// @throws IoError, FormatError (neither streets nor lines), CrsError when the file declares no CRS
std::vector<Eigen::Vector2d> places_along_axis(const std::filesystem::path& file, const Crs& prior);

}  // namespace priormap
