#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <priormap/simulation/terrain.hpp>
#include <priormap/sources/footprint.hpp>
#include <priormap/tessellation/polygon.hpp>

namespace priormap {

// The true town, frame `map` [m]. What the prior's sources say of it is in source_view.hpp.

/// Plane z = slope . p + z0 of a roof.
struct RoofPlane {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double z0 = 0;
  double height(const Eigen::Vector2d& p) const { return slope.dot(p) + z0; }
};

struct Building {
  std::string id;                  ///< unique in the town: "g17" generated, "way/123" from OSM
  Polygon2 outline;                ///< of the walls, as after `normalize`
  double ground_z = 0;             ///< median ground along the outline
  double base_z = 0;               ///< foot of the walls, below the lowest ground along the outline
  double eaves_z = 0;
  RoofShape roof_shape = RoofShape::flat;
  std::vector<RoofPlane> roof;     ///< the roof is the lowest of these planes
  double overhang_m = 0;
  double storey_height_m = 3;
  double balcony_share = 0;        ///< of the windows above the ground floor
  bool surveyed = true;            ///< stood already when the surface model was flown
  std::optional<BuildingAttributes> source;   ///< what the OSM file it comes from says of it

  double roof_height(const Eigen::Vector2d& p) const;   ///< z of the roof's plane above p
  double top_z() const;                                 ///< highest point of the roof over the outline
  double height_m() const { return top_z() - ground_z; }
};

struct Street {
  std::string name;
  std::vector<Eigen::Vector2d> line;
  double half_width_m = 4;
};

struct Tree {
  Eigen::Vector3d foot;
  double trunk_radius_m, trunk_height_m;
  Eigen::Vector3d crown_radius_m;
};

struct Pole {
  Eigen::Vector3d foot;
  double radius_m, height_m;
};

struct Car {
  Eigen::Vector3d position;   ///< on the ground, below the middle
  double yaw;                 ///< counter-clockwise from east
  Eigen::Vector3d size_m;     ///< length, width, height
};

struct Barrier {
  enum class Kind : std::uint8_t { hedge, fence, wall } kind;
  Eigen::Vector2d from, to;
  double height_m;
};

struct Town {
  Terrain terrain;
  std::vector<Street> streets;
  std::vector<Building> buildings;
  std::vector<Tree> trees;
  std::vector<Pole> poles;
  std::vector<Car> parked_cars;
  std::vector<Barrier> barriers;
};

/// Unit direction of the long side of the smallest oriented rectangle around a ring.
Eigen::Vector2d main_axis(const Ring2& ring);

/// Planes of a roof over an outline, its ridge along `ridge` (unit); eaves at `eaves_z` on the rectangle around the outline along `ridge`.
/// Shapes that are neither flat nor skillion become gabled, or hipped where they slope to all sides.
/// @param pitch  height gained per metre (gabled, hipped; half of it for skillion roofs)
std::vector<RoofPlane> roof_planes(const Ring2& outline, RoofShape shape, const Eigen::Vector2d& ridge, double eaves_z, double pitch);

/// Puts a building onto the ground: fills ground_z, base_z, eaves_z and the roof.
/// @param eaves_height_m  above the median ground along the outline
void place_on_ground(Building& building, const Terrain& terrain, double eaves_height_m, const Eigen::Vector2d& ridge, double pitch);

}  // namespace priormap
