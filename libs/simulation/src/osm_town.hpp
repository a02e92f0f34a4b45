#pragma once
#include <filesystem>

#include <priormap/geodesy/map_frame.hpp>
#include <priormap/simulation/source_view.hpp>
#include <priormap/simulation/street_graph.hpp>
#include <priormap/simulation/town.hpp>
#include <priormap/sources/osm_streets.hpp>

namespace priormap {

/// The buildings and streets of an OSM file, longitude and latitude WGS 84 [deg].
class OsmTown {
 public:
  /// @throws IoError, FormatError when the file holds no street
  OsmTown(const std::filesystem::path& file, int threads);

  /// Middle of its streets.
  Eigen::Vector2d centre_lon_lat() const;

  /// Outlines as the file has them, in `frame`, with what it says of them; not yet on the ground.
  std::vector<Building> buildings(const MapFrame& frame) const;

  /// The largest connected part of the streets, in `frame`, without those that lead through a building.
  StreetGraph streets(const MapFrame& frame, const std::vector<Building>& buildings) const;

 private:
  std::filesystem::path file_;
  FootprintList footprints_;
  std::vector<OsmStreet> streets_;
};

/// Makes true buildings of source outlines: moves each by the inverse of its error, so that `draw_building_error` leads back to the file, and
/// invents what the file does not say: height, pitched roof, balconies.
void raise_buildings(std::vector<Building>& buildings, const Terrain& terrain, const SourceErrorOptions& errors, double unsurveyed_share,
                     std::uint64_t seed);

}  // namespace priormap
