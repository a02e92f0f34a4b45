#pragma once
#include <Eigen/Core>

#include <priormap/geodesy/crs.hpp>

namespace priormap {

/// Of the CRS's ellipsoid at a latitude: along the meridian (M) and across it (N).
Eigen::Vector2d curvature_radii_m(const Crs& crs, double lat_deg);
/// sqrt(M N) of the CRS's ellipsoid at a latitude: the radius of the sphere that fits it best there.
double gaussian_radius_m(const Crs& crs, double lat_deg);

}  // namespace priormap
