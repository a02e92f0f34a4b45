#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <priormap/geodesy/transformer.hpp>
#include <priormap/prior/tile_index.hpp>

namespace priormap {

/// One input of a prior: what a user must know to trust it and to name it.
struct PriorSource {
  std::string id;              ///< short and unique in the prior, such as "osm-1a2b3c4d"
  std::string kind;            ///< "osm", "raster", "citygml", "cityjson", "footprints", "airborne", "mapper"
  std::string file_name;       ///< without its folder
  std::string sha256;          ///< of the input file
  std::string license;         ///< SPDX id or free text; empty: unknown
  std::string attribution;
  std::string date;            ///< YYYY-MM-DD of the data; empty: unknown
  std::string crs;             ///< the input's CRS as read or declared
  std::string assumed_vertical; ///< vertical CRS taken on the user's word; empty: none
  CoordinateOperation operation;
  std::optional<double> sigma_m;          ///< a priori position accuracy of its points
  int precedence = 0;          ///< of a merged prior: sources with a lower number displaced points of those with a higher one
  std::vector<std::pair<std::string, std::string>> facts;  ///< counts and rules for the reader: "buildings" = "494", ...
};

/// The content of prior.json but for the tile list, which is tiles.idx (decision 6).
struct PriorManifest {
  std::string crs;                       ///< of the tiles; horizontal or compound ("EPSG:25832+7837"); empty: a local metric frame
  std::optional<std::string> vertical;   ///< vertical part, nullopt: heights undeclared ("vertical": null)
  double tile_size = 200;
  double spacing_m = 0.5;
  std::vector<PriorSource> sources;      ///< PointCloud::source indexes this
  std::uint64_t num_points = 0;
  std::uint64_t num_features = 0;
  Eigen::Vector3d min = Eigen::Vector3d::Zero(), max = Eigen::Vector3d::Zero();
  std::uint64_t num_tiles = 0;
  TileIndexDigest tiles;                 ///< of tiles.idx
  std::string features_crs;              ///< of the geometry in features.geojsonl: "EPSG:4326" where an operation to it is known
  std::string features_operation;        ///< PROJ pipeline from there to `crs`, where it is not the one that PROJ ranks first; else empty
  std::string features_sha256;           ///< of features.geojsonl
  std::string generator;                 ///< "osm2prior 0.1.0"
};

/// @throws FormatError naming the field that violates schemas/prior-manifest.schema.json; IoError
PriorManifest read_manifest(const std::filesystem::path& prior_directory);

/// The text of prior.json: the same manifest gives the same bytes.
std::string manifest_json(const PriorManifest& manifest);

/// The text of ATTRIBUTION.txt: who must be named, and under which licences the data stands.
std::string attribution_text(const PriorManifest& manifest);

/// The files of a prior directory.
inline constexpr const char* manifest_file_name = "prior.json";
inline constexpr const char* tile_index_file_name = "tiles.idx";
inline constexpr const char* features_file_name = "features.geojsonl";
inline constexpr const char* attribution_file_name = "ATTRIBUTION.txt";
inline constexpr const char* tiles_folder_name = "tiles";

}  // namespace priormap
