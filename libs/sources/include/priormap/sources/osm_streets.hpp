#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace priormap {

/// A street that cars may use, as OSM draws it: streets meet where they share a node.
struct OsmStreet {
  std::string id;                              ///< "way/123"
  std::string name;                            ///< empty: none
  std::vector<std::int64_t> nodes;
  std::vector<Eigen::Vector2d> lon_lat;        ///< of the nodes, WGS 84 [deg]
  double width_m = 0;                          ///< as tagged, else usual for its kind
};

/// Streets of OSM files (.osm, .osm.gz, .osm.bz2, .osm.pbf), ordered by id, the objects of a file in any order; tunnels, areas and ways that miss a node are left out.
/// @throws IoError, FormatError naming the file
std::vector<OsmStreet> read_osm_streets(const std::filesystem::path& file);

}  // namespace priormap
