#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace priormap {

/// One line of features.geojsonl: where a group of points comes from.
struct Feature {
  std::string source = {};                      ///< PriorSource::id
  std::string id = {};                          ///< in that source: "way/123", "relation/7", a gml:id
  double height_m = 0;                     ///< of the roof's top above the ground
  std::string height_rule = {};                 ///< "tag", "dsm", "levels", "default", "model"
  double ground_z = 0;
  double sigma_m = 0;
  /// Outline(s) in the prior's CRS; polygons of rings, exterior first, each closed implicitly.
  std::vector<std::vector<std::vector<Eigen::Vector2d>>> outline = {};
};

}  // namespace priormap
