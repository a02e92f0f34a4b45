#pragma once
#include <filesystem>

#include <priormap/sources/building_model.hpp>

namespace priormap {

enum class CityJsonLayout {
  document,   ///< one CityJSON object
  sequence,   ///< CityJSONSeq: a header line, then one CityJSONFeature a line
};

/// By name: .jsonl and .ndjson are sequences; others by content, where a second object follows the first line. A file that cannot be opened is a document.
CityJsonLayout cityjson_layout(const std::filesystem::path& file);

/// Streams the buildings, bridges, plants and TINReliefs of CityJSON 1.0 to 2.0 or CityJSONSeq (CityJSON specification 2.0.1): transform, LoD
/// strings ("2.2" counts above "2"), geometry templates, semantic surfaces, CRS URLs. The vertices of a CityJSON file are
/// held in memory (24 bytes each), its city objects are not.
/// @throws IoError; FormatError: not JSON (with the place), no CityJSON, an index outside the vertices, nesting deeper than 64.
void read_cityjson(const std::filesystem::path& file, CityJsonLayout layout, const BuildingModelOptions& options, const BuildingModelSink& sink);

}  // namespace priormap
