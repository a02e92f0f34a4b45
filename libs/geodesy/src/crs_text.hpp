#pragma once
#include <string>

namespace priormap {

/// What PROJ calls the CRS that `text` means: knows the srsName forms of GML and of the German survey (GeoInfoDok) that PROJ
/// does not. Names such as "CH1903" are refused: PROJ would take them for whatever object is called alike.
/// @throws CrsError when the text has none of the forms that Crs::parse lists.
std::string proj_definition(const std::string& text);

}  // namespace priormap
