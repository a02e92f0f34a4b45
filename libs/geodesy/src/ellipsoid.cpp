#include "ellipsoid.hpp"

#include <GeographicLib/Ellipsoid.hpp>
#include <cmath>

#include <priormap/core/error.hpp>

#include "crs_text.hpp"

namespace priormap {

Eigen::Vector2d curvature_radii_m(const Crs& crs, double lat_deg) {
  const ProjContext& context = ProjContext::of_thread();
  const ProjObject object = create_crs(context, crs.name());
  const ProjObject shape(object ? proj_get_ellipsoid(context, object.get()) : nullptr);
  double semi_major_m = 0, inverse_flattening = 0;
  if (!shape || !proj_ellipsoid_get_parameters(context, shape.get(), &semi_major_m, nullptr, nullptr, &inverse_flattening))
    throw CrsError(crs.human_name() + " has no ellipsoid");
  const GeographicLib::Ellipsoid ellipsoid(semi_major_m, inverse_flattening > 0 ? 1 / inverse_flattening : 0);
  return {ellipsoid.MeridionalCurvatureRadius(lat_deg), ellipsoid.TransverseCurvatureRadius(lat_deg)};
}

double gaussian_radius_m(const Crs& crs, double lat_deg) { return std::sqrt(curvature_radii_m(crs, lat_deg).prod()); }

}  // namespace priormap
