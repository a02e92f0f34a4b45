#pragma once
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

namespace priormap {

/// What OSM XML says beside its objects, and libosmium does not tell.
struct OsmXmlNotes {
  std::string remark;   ///< of Overpass, when it broke off its answer; empty: none
  std::set<std::pair<std::string, std::int64_t>> deleted;   ///< "node", "way" or "relation", and id: deleted in JOSM and not yet uploaded (action="delete")
};

/// Nothing for files that are no XML. @throws IoError, FormatError
OsmXmlNotes read_osm_xml_notes(const std::filesystem::path& file);

}  // namespace priormap
