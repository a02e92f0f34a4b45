#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <priormap/core/option_field.hpp>

namespace priormap {

/// Points inside --bbox, and how many of them --visible-from left out.
struct SightCounts {
  std::size_t sampled = 0;
  std::size_t out_of_sight = 0;

  SightCounts& operator+=(const SightCounts& other) {
    sampled += other.sampled;
    out_of_sight += other.out_of_sight;
    return *this;
  }
};

/// Which points of buildings a drive could ever see: the rest can be left out.
struct SightOptions {
  std::string visible_from;      ///< streets or a track; empty: every point stays
  double sensor_height_m = 1.8;
  double view_range_m = 100;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("visible-from", visible_from, {"streets (.osm.pbf, .osm) or a track (.geojson, .gpkg): leaves out what no ray from there reaches"});
    visit("sensor-height", sensor_height_m, {"of the sensor above the road, for --visible-from", "m", 0, 100});
    visit("view-range", view_range_m, {"how far the sensor sees, for --visible-from", "m", 1, 1000});
  }

  bool is_active() const { return !visible_from.empty(); }
  /// @throws FormatError naming the file when none of the points can be seen from it: it lies elsewhere.
  void refuse_blindness(const SightCounts& counts) const;
};

/// For the manifest: what was asked and what it left out; nothing where --visible-from is not given.
std::vector<std::pair<std::string, std::string>> sight_facts(const SightOptions& options, const SightCounts& counts);

/// "1234 (12.3 %)"
std::string to_text(const SightCounts& counts);

}  // namespace priormap
