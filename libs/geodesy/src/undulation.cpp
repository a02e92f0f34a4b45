#include <priormap/geodesy/undulation.hpp>

#include <priormap/geodesy/transformer.hpp>

namespace priormap {

double egm96_undulation_m(double lon_deg, double lat_deg) {
  const Transformer above_ellipsoid_to_geoid(Crs::parse("EPSG:4979"), Crs::parse("EPSG:4326+5773"));
  return -above_ellipsoid_to_geoid.forward(Eigen::Vector3d(lon_deg, lat_deg, 0)).z();
}

}  // namespace priormap
