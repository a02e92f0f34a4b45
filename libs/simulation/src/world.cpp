#include <priormap/simulation/world.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <priormap/simulation/random.hpp>

#include "building_mesh.hpp"
#include "distance_field.hpp"
#include "mesh_parts.hpp"
#include "stream.hpp"

namespace priormap {
namespace {

Eigen::Vector3d random_direction(Random& random) {
  const double z = random.uniform(-1, 1), angle = random.uniform(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Leaves: small squares, turned at random, denser towards the outside of the crown.
void append_crown(TriangleMesh& mesh, const Tree& tree, Random& random) {
  constexpr double leaf_m = 0.18, leaves_per_m3 = 3.5;
  const Eigen::Vector3d centre = tree.foot + Eigen::Vector3d(0, 0, tree.trunk_height_m + 0.8 * tree.crown_radius_m.z());
  const double volume = 4.0 / 3 * std::numbers::pi * tree.crown_radius_m.prod();
  const int num_leaves = std::clamp(static_cast<int>(leaves_per_m3 * volume), 40, 400);
  for (int i = 0; i < num_leaves; ++i) {
    const double radius = std::pow(random.uniform(), 0.25);
    const Eigen::Vector3d at = centre + radius * tree.crown_radius_m.cwiseProduct(random_direction(random));
    const Eigen::Vector3d u = random_direction(random), v = u.unitOrthogonal();
    append_quad(mesh, at - leaf_m * u - leaf_m * v, at + leaf_m * u - leaf_m * v, at + leaf_m * u + leaf_m * v, at - leaf_m * u + leaf_m * v);
  }
}

void append_pole(TriangleMesh& mesh, const Pole& pole) {
  append_cylinder(mesh, pole.foot, pole.radius_m, pole.height_m, 8);
}

void append_barrier(TriangleMesh& mesh, const Barrier& barrier, const Terrain& terrain) {
  constexpr double piece_m = 2.0, sunk_m = 0.2, post_m = 0.08, board_m = 0.12;
  const Eigen::Vector2d run = barrier.to - barrier.from;
  const int pieces = std::max(1, static_cast<int>(run.norm() / piece_m));
  const double yaw = std::atan2(run.y(), run.x()), length = run.norm() / pieces;
  for (int i = 0; i < pieces; ++i) {
    const Eigen::Vector2d middle = barrier.from + run * (i + 0.5) / pieces, start = barrier.from + run * i / pieces;
    const auto on_ground = [&](const Eigen::Vector2d& p, double above) { return Eigen::Vector3d(p.x(), p.y(), terrain.height(p) + above); };
    if (barrier.kind == Barrier::Kind::fence) {
      append_box(mesh, upright(on_ground(start, -sunk_m), yaw), {post_m, post_m, barrier.height_m + sunk_m});
      for (const double share : {0.2, 0.55, 0.9})
        append_box(mesh, upright(on_ground(middle, share * barrier.height_m), yaw), {length, 0.03, board_m});
    } else {
      const double thickness = barrier.kind == Barrier::Kind::hedge ? 0.6 : 0.25;
      append_box(mesh, upright(on_ground(middle, -sunk_m), yaw), {length, thickness, barrier.height_m + sunk_m});
    }
  }
}

/// Collects the parts of one material and survey kind.
class Parts {
 public:
  TriangleMesh& operator()(Material material, Survey survey) {
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i].material == material && parts_[i].survey == survey) return meshes_[i];
    parts_.push_back({material, survey});
    meshes_.reserve(max_parts);   // references handed out stay valid
    return meshes_.emplace_back();
  }
  std::vector<WorldPart> parts_;
  std::vector<TriangleMesh> meshes_;

 private:
  static constexpr std::size_t max_parts = 32;
};

void append_buildings(Parts& parts, const Town& town, std::uint64_t seed) {
  for (const Survey survey : {Survey::seen, Survey::ignored}) {
    BuildingMeshes meshes;
    for (std::size_t i = 0; i < town.buildings.size(); ++i)
      if (town.buildings[i].surveyed == (survey == Survey::seen))
        append_building(meshes, town.buildings[i], Random(seed, {stream::facade, i}));
    parts(Material::wall, survey) = std::move(meshes.walls);
    parts(Material::glass, survey) = std::move(meshes.glass);
    parts(Material::roof, survey) = std::move(meshes.roof);
  }
}

void append_ground(Parts& parts, const Town& town) {
  constexpr double reach_m = 10;
  DistanceField to_street(town.terrain.bounds(), reach_m);
  for (const Street& street : town.streets) to_street.add(street.line, street.half_width_m);
  const auto on_street = [&](const Eigen::Vector2d& p) { return to_street.distance(p) <= 0; };
  parts(Material::asphalt, Survey::seen) = town.terrain.mesh(on_street);
  parts(Material::lawn, Survey::seen) = town.terrain.mesh([&](const Eigen::Vector2d& p) { return !on_street(p); });
}

}  // namespace

void append_car(TriangleMesh& body, TriangleMesh& glass, const Car& car) {
  constexpr double clearance_m = 0.2;
  const Eigen::Isometry3d T_map_car = upright(car.position, car.yaw);
  const double length = car.size_m.x(), width = car.size_m.y(), height = car.size_m.z(), waist = 0.6 * height;
  append_box(body, T_map_car * Eigen::Translation3d(0, 0, clearance_m), {length, width, waist - clearance_m});
  const auto at = [&](double x, double y, double z) { return Eigen::Vector3d(T_map_car * Eigen::Vector3d(x, y, z)); };
  // Cabin: a frustum from the waist to the roof, glass all around.
  const double low_front = 0.22 * length, low_back = -0.40 * length, front = 0.05 * length, back = -0.30 * length;
  const double low_side = 0.5 * width, side = 0.40 * width;
  const Eigen::Vector3d low[4] = {at(low_front, -low_side, waist), at(low_front, low_side, waist), at(low_back, low_side, waist),
                                  at(low_back, -low_side, waist)};
  const Eigen::Vector3d high[4] = {at(front, -side, height), at(front, side, height), at(back, side, height), at(back, -side, height)};
  for (int i = 0; i < 4; ++i) append_quad(glass, low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]);
  append_quad(body, high[0], high[1], high[2], high[3]);
}

World build_world(const Town& town, std::uint64_t seed) {
  Parts parts;
  append_ground(parts, town);
  append_buildings(parts, town, seed);
  for (std::size_t i = 0; i < town.trees.size(); ++i) {
    Random random(seed, {stream::leaves, i});
    const Tree& tree = town.trees[i];
    append_cylinder(parts(Material::bark, Survey::ignored), tree.foot, tree.trunk_radius_m, tree.trunk_height_m + tree.crown_radius_m.z(), 8);
    append_crown(parts(Material::foliage, Survey::seen), tree, random);
  }
  for (const Pole& pole : town.poles) append_pole(parts(Material::metal, Survey::ignored), pole);
  for (const Car& car : town.parked_cars)
    append_car(parts(Material::paint, Survey::ignored), parts(Material::glass, Survey::ignored), car);
  for (const Barrier& barrier : town.barriers) {
    const Material material = barrier.kind == Barrier::Kind::hedge ? Material::foliage
                              : barrier.kind == Barrier::Kind::fence ? Material::bark : Material::wall;
    append_barrier(parts(material, Survey::ignored), barrier, town.terrain);
  }
  const Bounds2 bounds = town.terrain.bounds();
  const Eigen::Vector2d centre(0.5 * (bounds.min_x + bounds.max_x), 0.5 * (bounds.min_y + bounds.max_y));
  const Eigen::Vector3d origin(centre.x(), centre.y(), town.terrain.height(centre));
  RayScene scene(parts.meshes_, origin);
  return {std::move(parts.parts_), std::move(parts.meshes_), std::move(scene)};
}

std::vector<float> World::surface_heights(const std::vector<Eigen::Vector2d>& p_map) const {
  constexpr float ceiling_m = 500, step_m = 1e-3f;
  constexpr std::size_t chunk = 4096;
  std::vector<float> heights(p_map.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<Ray> rays;
  std::vector<RayHit> hits;
  std::vector<std::size_t> open;   // rays that have only met what the survey ignores
  for (std::size_t first = 0; first < p_map.size(); first += chunk) {
    rays.clear();
    open.clear();
    for (std::size_t i = first; i < std::min(first + chunk, p_map.size()); ++i) {
      const Eigen::Vector2f p = (p_map[i] - scene.origin().head<2>()).cast<float>();
      rays.push_back({{p.x(), p.y(), ceiling_m}, -Eigen::Vector3f::UnitZ()});
      open.push_back(i);
    }
    while (!rays.empty()) {
      hits.resize(rays.size());
      scene.cast(rays, 2 * ceiling_m, hits);
      std::size_t kept = 0;
      for (std::size_t k = 0; k < rays.size(); ++k) {
        if (!hits[k].hit()) continue;
        const float z = rays[k].origin.z() - hits[k].range_m;
        if (parts[hits[k].mesh].survey == Survey::seen) {
          heights[open[k]] = static_cast<float>(z + scene.origin().z());
          continue;
        }
        rays[kept] = rays[k];
        rays[kept].origin.z() = z - step_m;
        open[kept++] = open[k];
      }
      rays.resize(kept);
      open.resize(kept);
    }
  }
  return heights;
}

}  // namespace priormap
