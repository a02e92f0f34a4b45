#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include <priormap/core/diagnostics.hpp>
#include <priormap/core/option_field.hpp>
#include <priormap/geodesy/crs.hpp>
#include <priormap/sources/footprint.hpp>

namespace priormap {

/// Where a layer of outlines keeps what it knows. Empty: nowhere.
struct FootprintFields {
  std::string layer;     ///< empty: every layer with polygons
  std::string height;
  std::string levels;
  std::string id;        ///< empty: the feature's own number

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("layer", layer, {"layer to read; default: every layer with polygons"});
    visit("height-field", height, {"field with the building's height above the ground: a number of metres, or text with a unit"});
    visit("levels-field", levels, {"field with the number of storeys above the ground"});
    visit("id-field", id, {"field that names the building; default: the feature's number"});
  }
};

/// Polygons of any vector file that OGR reads: GeoPackage, Shapefile, GeoJSON, FlatGeobuf ... Curves are replaced by chords. Ids are "LAYER/NUMBER" or "LAYER/ID".
/// Field values that are no height or count are reported (702) and treated as absent; features without a polygon are left out (101).
/// @param footprints  to append to: east before north, in the CRS that is returned; heights of the geometry are not used
/// @param file_index  `Footprint::file` of what is appended
/// @return the CRS of all layers, horizontal; none: they declare none
/// @throws IoError, FormatError (no vector file, no polygons), UsageError (no such layer or field), CrsError when layers of the file differ in their CRS
std::optional<Crs> read_ogr_footprints(const std::filesystem::path& file, const FootprintFields& fields, Diagnostics& diagnostics, FootprintList& footprints,
                                       std::uint16_t file_index = 0);

}  // namespace priormap
