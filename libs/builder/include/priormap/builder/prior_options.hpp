#pragma once
#include <optional>
#include <string>
#include <vector>

#include <priormap/core/events.hpp>
#include <priormap/core/option_field.hpp>
#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {

/// What every tool that makes a prior asks alike, whatever its source. Empty text: not given.
struct PriorOptions {
  std::string crs;              ///< of the prior, projected
  std::string source_crs;       ///< declares or overrides the input's CRS
  std::string assume_vertical;  ///< vertical CRS that undeclared heights are taken for
  std::vector<double> bbox;     ///< west, south, east, north in `bbox_crs`, half-open; empty: everything; east of west but across the antimeridian (179,-18,-179,-17)
  std::string bbox_crs = "EPSG:4326";
  std::optional<double> spacing_m;  ///< none: the source's own sampling, or 0.5 m where it has none
  double tile_size_m = 200;
  std::string attribution;
  std::string license;
  std::string date;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("crs", crs, {"CRS of the prior, such as EPSG:25832+7837; default: the UTM zone of the data, heights as declared"});
    visit("source-crs", source_crs, {"declares or overrides the input's CRS, such as EPSG:27700+5701"});
    visit("assume-vertical", assume_vertical, {"takes undeclared heights as heights in this vertical CRS, such as EPSG:5773"});
    visit("bbox", bbox, {"W,S,E,N: keeps the points inside, half-open"});
    visit("bbox-crs", bbox_crs, {"CRS of --bbox"});
    visit("spacing", spacing_m, {"distance between points; default: 0.5, or the raster's own sampling", "m", 0.01, 1000});
    visit("tile-size", tile_size_m, {"edge of a tile", "m", 1, 5000});
    visit("attribution", attribution, {"who must be named by users of the data"});
    visit("license", license, {"SPDX identifier of the data's licence"});
    visit("date", date, {"date of the data, YYYY-MM-DD"});
  }

  /// @throws UsageError for a bbox that is not four numbers with W < E and S < N, or a date that is no date.
  /// Warns of a licence that is no SPDX identifier.
  void validate(const Events& events = {}) const;
  /// Of a valid bbox that is not empty: its east counts on beyond 180 degrees where it crosses the antimeridian.
  Bounds2 box() const;
  double spacing_or(double fallback_m) const { return spacing_m.value_or(fallback_m); }
};

}  // namespace priormap
