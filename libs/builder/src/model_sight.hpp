#pragma once
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <priormap/builder/line_of_sight.hpp>
#include <priormap/builder/sight_options.hpp>
#include <priormap/geodesy/crs.hpp>

#include "model_faces.hpp"

namespace priormap {

/// Collects what a city of models hides, and where its ground is: models know no terrain but the feet of their walls.
class ModelSight {
 public:
  explicit ModelSight(const SightOptions& options) : options_(options) {}

  /// A building in the prior's CRS.
  void add(const std::vector<ModelFace>& faces);
  /// Once, after the last `add`. The sensor drives above the nearest foot of a wall within reach.
  LineOfSight finish(const Crs& prior);

 private:
  std::optional<double> ground_z(const Eigen::Vector2d& place) const;

  const SightOptions& options_;
  TriangleMesh occluders_;
  std::map<std::pair<int, int>, double> feet_z_;   ///< the lowest in each square of 5 m
};

}  // namespace priormap
