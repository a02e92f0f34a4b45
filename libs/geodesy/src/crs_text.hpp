#pragma once
#include <string>

#include "proj_context.hpp"

namespace priormap {

/// What PROJ calls the CRS that `text` means: knows the srsName forms of GML and of the German survey (GeoInfoDok) that PROJ
/// does not. Names such as "CH1903" are refused: PROJ would take them for whatever object is called alike.
/// @throws CrsError when the text has none of the forms that Crs::parse lists.
std::string proj_definition(const std::string& text);

/// The CRS of a definition or of a Crs's name; null where PROJ knows none. Codes are looked up part by part: PROJ takes
/// "EPSG:25832+7837" for a name first and searches the whole registry for it.
ProjObject create_crs(const ProjContext& context, const std::string& definition);

}  // namespace priormap
