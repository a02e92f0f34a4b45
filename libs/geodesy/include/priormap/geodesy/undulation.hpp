#pragma once

namespace priormap {

/// Height of the EGM96 geoid (15' grid, NGA) above the WGS 84 ellipsoid. Good to about a metre: for scales, never for heights.
/// @throws CrsError when PROJ's grid egm96_15 is not installed.
double egm96_undulation_m(double lon_deg, double lat_deg);

}  // namespace priormap
