#pragma once
#include <filesystem>
#include <vector>

#include <priormap/core/diagnostics.hpp>
#include <priormap/core/events.hpp>
#include <priormap/sources/footprint.hpp>

namespace priormap {

/// Buildings and building parts of OSM files (.osm, .osm.gz, .osm.bz2, .osm.pbf): closed ways, multipolygon relations with holes, and relations of
/// type building that tie outlines and parts together. Longitude, latitude [degrees, WGS 84]. All files together are one data set: of an object that
/// they hold several times the highest version counts (of equal ones the first file's), nothing where that is deleted, and ways may find their nodes in another file. Ordered by id: the order of the files does not matter.
///
/// Nodes that no file holds lie where the ways say. A remark of Overpass is warned of, and versions one after the other in a file.
///
/// Reads each file three times (relations, ways, nodes; several files, or one in no order, the first two twice), so that only what buildings need is held: some 200 bytes a building, the rest in a temporary file.
/// Broken rings and members that no file holds are counted (103, 206, 701) and left out.
/// @throws IoError, FormatError naming the file
FootprintList read_osm_footprints(const std::vector<std::filesystem::path>& files, int threads, Diagnostics& diagnostics,
                                           const Events& events = {});

}  // namespace priormap
