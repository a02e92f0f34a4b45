#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <priormap/tessellation/polygon.hpp>

namespace priormap {

using OsmTags = std::map<std::string, std::string>;

/// A closed area, coordinates WGS 84 longitude, latitude [deg]. Without holes it becomes a closed way, with holes a multipolygon relation.
struct OsmArea {
  Polygon2 lon_lat;
  OsmTags tags;
};

/// An open way; vertices with exactly equal coordinates become one shared node, so that streets meet.
struct OsmLine {
  std::vector<Eigen::Vector2d> lon_lat;
  OsmTags tags;
};

struct OsmPlace {
  Eigen::Vector2d lon_lat;
  OsmTags tags;
};

/// What `write_osm` writes. Ids: nodes from 1, ways from 1 (areas first, in order, rings of an area one after the other, then lines),
/// relations from 1.
struct OsmExtract {
  std::vector<OsmArea> areas;
  std::vector<OsmLine> lines;
  std::vector<OsmPlace> places;
};

/// Writes .osm.pbf or .osm (by name), sorted by type and id, coordinates to 1e-7 deg, without times or users: same extract, same bytes.
/// Plain write: callers put it inside an AtomicFile or AtomicDirectory.
/// @throws IoError when the file cannot be written (its folder is absent, the disk is full, it exists).
void write_osm(const std::filesystem::path& file, const OsmExtract& extract);

}  // namespace priormap
