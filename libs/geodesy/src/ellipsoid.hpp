#pragma once
#include <priormap/geodesy/crs.hpp>

namespace priormap {

/// sqrt(M N) of the CRS's ellipsoid at a latitude: the radius of the sphere that fits it best there.
double gaussian_radius_m(const Crs& crs, double lat_deg);

}  // namespace priormap
