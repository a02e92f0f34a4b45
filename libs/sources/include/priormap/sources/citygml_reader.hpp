#pragma once
#include <filesystem>

#include <priormap/sources/building_model.hpp>

namespace priormap {

/// Streams the buildings and bridges (with their parts, installations and construction elements), plants and terrain TINs of a CityGML 1.0, 2.0 or 3.0
/// file (OGC 08-007, 12-019, 20-010), .gml, .xml or gzip-compressed. Memory holds one building at a time, the templates of
/// implicit geometry, and buildings that refer to geometry outside themselves (those follow last, after a second pass).
///
/// Geometry: every Polygon, Triangle or Rectangle below the lod1 to lod4 solids, multi- and composite surfaces, oriented
/// surfaces, xlinks (of polygons, surfaces and solids; in circles too) and implicit geometry. A polygon that is stated or
/// referenced several times counts once. Interior rooms, terrain intersections and LoD0 are left out.
///
/// @throws IoError; FormatError with the line: not XML, no CityGML, cut short, entity declarations, nesting deeper than 256,
/// a building of more than 8 million vertices.
void read_citygml(const std::filesystem::path& file, const BuildingModelOptions& options, const BuildingModelSink& sink);

}  // namespace priormap
