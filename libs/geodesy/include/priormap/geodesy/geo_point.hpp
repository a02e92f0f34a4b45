#pragma once

namespace priormap {

/// Geographic position. `height_m` is ellipsoidal or orthometric as the surrounding text says.
struct GeoPoint {
  double lat_deg = 0;
  double lon_deg = 0;
  double height_m = 0;
};

}  // namespace priormap
