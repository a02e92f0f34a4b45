#include <priormap/geodesy/undulation.hpp>

#include <cmath>

#include <priormap/core/error.hpp>

#include "proj_context.hpp"

namespace priormap {

double egm96_undulation_m(double lon_deg, double lat_deg) {
  const ProjContext& context = ProjContext::of_thread();
  const ProjObject geoid(proj_create(context,
                                     "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad "
                                     "+step +proj=vgridshift +grids=us_nga_egm96_15.tif +multiplier=1"));
  if (!geoid) throw CrsError("PROJ's grid of the EGM96 geoid is not installed; install the package proj-data");
  const double height_m = proj_trans(geoid.get(), PJ_FWD, proj_coord(lon_deg, lat_deg, 0, 0)).v[2];
  if (!std::isfinite(height_m)) throw CrsError("no EGM96 geoid at longitude " + std::to_string(lon_deg) + ", latitude " + std::to_string(lat_deg));
  return height_m;
}

}  // namespace priormap
