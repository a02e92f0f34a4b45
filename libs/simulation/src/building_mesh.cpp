#include "building_mesh.hpp"

#include <algorithm>
#include <cmath>

#include <priormap/tessellation/triangulate.hpp>

#include "mesh_parts.hpp"

namespace priormap {
namespace {

/// A wall seen from outside: s runs along it, z up, depth inwards.
struct WallFrame {
  Eigen::Vector2d start, along, outward;
  double length_m;
  Eigen::Vector3d at(double s, double z, double depth = 0) const {
    const Eigen::Vector2d p = start + s * along - depth * outward;
    return {p.x(), p.y(), z};
  }
};

void append_panel(TriangleMesh& mesh, const WallFrame& wall, double s0, double s1, double z0, double z1, double depth = 0) {
  append_quad(mesh, wall.at(s0, z0, depth), wall.at(s1, z0, depth), wall.at(s1, z1, depth), wall.at(s0, z1, depth));
}

struct Cell {
  double s0, s1, z0, z1;
};

/// Panel of wall with one recessed window.
void append_window(BuildingMeshes& meshes, const WallFrame& wall, const Cell& cell, const Cell& window, double depth) {
  append_panel(meshes.walls, wall, cell.s0, window.s0, cell.z0, cell.z1);
  append_panel(meshes.walls, wall, window.s1, cell.s1, cell.z0, cell.z1);
  append_panel(meshes.walls, wall, window.s0, window.s1, cell.z0, window.z0);
  append_panel(meshes.walls, wall, window.s0, window.s1, window.z1, cell.z1);
  append_panel(meshes.glass, wall, window.s0, window.s1, window.z0, window.z1, depth);
  const Eigen::Vector2d corners[4] = {{window.s0, window.z0}, {window.s1, window.z0}, {window.s1, window.z1}, {window.s0, window.z1}};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d a = corners[i], b = corners[(i + 1) % 4];
    append_quad(meshes.walls, wall.at(a.x(), a.y()), wall.at(b.x(), b.y()), wall.at(b.x(), b.y(), depth), wall.at(a.x(), a.y(), depth));
  }
}

void append_balcony(TriangleMesh& mesh, const WallFrame& wall, const Cell& cell) {
  constexpr double depth_m = 1.3, railing_m = 1.0, slab_m = 0.2;
  const double s0 = cell.s0 + 0.2, s1 = cell.s1 - 0.2, low = cell.z0 - slab_m, high = cell.z0 + railing_m;
  append_quad(mesh, wall.at(s0, low, -depth_m), wall.at(s1, low, -depth_m), wall.at(s1, high, -depth_m), wall.at(s0, high, -depth_m));
  append_quad(mesh, wall.at(s0, low), wall.at(s0, low, -depth_m), wall.at(s0, high, -depth_m), wall.at(s0, high));
  append_quad(mesh, wall.at(s1, low, -depth_m), wall.at(s1, low), wall.at(s1, high), wall.at(s1, high, -depth_m));
  append_quad(mesh, wall.at(s0, low), wall.at(s1, low), wall.at(s1, low, -depth_m), wall.at(s0, low, -depth_m));
  append_quad(mesh, wall.at(s0, cell.z0), wall.at(s1, cell.z0), wall.at(s1, cell.z0, -depth_m), wall.at(s0, cell.z0, -depth_m));
}

/// Storeys of windows on the rectangle between the ground and `top_z`.
void append_storeys(BuildingMeshes& meshes, const Building& building, const WallFrame& wall, double top_z, Random& random) {
  constexpr double column_m = 3.0, min_length_m = 2.4, min_lintel_m = 0.3;
  const int columns = wall.length_m < min_length_m ? 0 : std::max(1, static_cast<int>(wall.length_m / column_m));
  const int storeys = std::max(0, static_cast<int>((top_z - building.ground_z - min_lintel_m) / building.storey_height_m));
  if (columns == 0 || storeys == 0) {
    append_panel(meshes.walls, wall, 0, wall.length_m, building.base_z, top_z);
    return;
  }
  const double windows_top = building.ground_z + storeys * building.storey_height_m;
  append_panel(meshes.walls, wall, 0, wall.length_m, building.base_z, building.ground_z);
  append_panel(meshes.walls, wall, 0, wall.length_m, windows_top, top_z);
  const double width = wall.length_m / columns, recess_m = random.uniform(0.1, 0.25);
  const double window_width = std::min(0.6 * width, random.uniform(1.0, 1.6)), window_height = random.uniform(1.2, 1.6);
  const double window_share = random.uniform(0.5, 0.95);
  for (int storey = 0; storey < storeys; ++storey)
    for (int column = 0; column < columns; ++column) {
      const Cell cell{column * width, (column + 1) * width, building.ground_z + storey * building.storey_height_m,
                      building.ground_z + (storey + 1) * building.storey_height_m};
      const bool has_window = random.chance(window_share), has_balcony = random.chance(building.balcony_share);
      if (!has_window) {
        append_panel(meshes.walls, wall, cell.s0, cell.s1, cell.z0, cell.z1);
        continue;
      }
      const double middle = 0.5 * (cell.s0 + cell.s1), sill = cell.z0 + 0.9;
      const Cell window{middle - 0.5 * window_width, middle + 0.5 * window_width, sill,
                        std::min(sill + window_height, cell.z1 - 0.1)};
      append_window(meshes, wall, cell, window, recess_m);
      if (storey > 0 && has_balcony) append_balcony(meshes.walls, wall, cell);
    }
}

/// The part of a wall above `low_z`, up to the roof: triangles of gables and the steps of sloping edges.
void append_gable(TriangleMesh& mesh, const Building& building, const WallFrame& wall, double low_z) {
  const Eigen::Vector2d end = wall.start + wall.length_m * wall.along;
  std::vector<double> breaks{0, wall.length_m};
  for (std::size_t i = 0; i < building.roof.size(); ++i)
    for (std::size_t j = i + 1; j < building.roof.size(); ++j) {
      const double at_start = building.roof[i].height(wall.start) - building.roof[j].height(wall.start);
      const double at_end = building.roof[i].height(end) - building.roof[j].height(end);
      if (at_start * at_end < 0) breaks.push_back(wall.length_m * at_start / (at_start - at_end));
    }
  std::sort(breaks.begin(), breaks.end());
  const auto top = [&](double s) { return building.roof_height(wall.start + s * wall.along); };
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double s0 = breaks[i], s1 = breaks[i + 1];
    append_quad(mesh, wall.at(s0, low_z), wall.at(s1, low_z), wall.at(s1, top(s1)), wall.at(s0, top(s0)));
  }
}

void append_wall(BuildingMeshes& meshes, const Building& building, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                 Random& random) {
  constexpr double min_length_m = 0.01;
  const Eigen::Vector2d edge = to - from;
  if (edge.norm() < min_length_m) return;
  const Eigen::Vector2d along = edge.normalized();
  const WallFrame wall{from, along, {along.y(), -along.x()}, edge.norm()};
  // The roof is concave along the edge: its lowest point is an end.
  const double low_z = std::min(building.roof_height(from), building.roof_height(to));
  append_storeys(meshes, building, wall, low_z, random);
  append_gable(meshes.walls, building, wall, low_z);
}

/// Ring moved outwards by `distance`; corners mitred, sharp ones no farther than twice that.
Ring2 grown(const Ring2& ring, double distance) {
  Ring2 result;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d before = (ring[i] - ring[(i + ring.size() - 1) % ring.size()]).normalized();
    const Eigen::Vector2d after = (ring[(i + 1) % ring.size()] - ring[i]).normalized();
    const Eigen::Vector2d outward(before.y() + after.y(), -before.x() - after.x());   // sum of the two unit normals
    result.push_back(ring[i] + 2 * distance / std::max(1.0, outward.squaredNorm()) * outward);
  }
  return result;
}

/// The part of a convex polygon where `left` is not above `right`.
std::vector<Eigen::Vector2d> clip_where_lower(const std::vector<Eigen::Vector2d>& polygon, const RoofPlane& left, const RoofPlane& right) {
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double da = right.height(a) - left.height(a), db = right.height(b) - left.height(b);
    if (da >= 0) kept.push_back(a);
    if (da * db < 0) kept.push_back(a + da / (da - db) * (b - a));
  }
  return kept;
}

void append_roof(TriangleMesh& mesh, const Building& building) {
  Polygon2 eaves = building.outline;
  if (building.overhang_m > 0) eaves.exterior = grown(eaves.exterior, building.overhang_m);
  const TriangleMesh flat = triangulate(eaves);
  for (const auto& triangle : flat.triangles)
    for (const RoofPlane& plane : building.roof) {
      std::vector<Eigen::Vector2d> facet;
      for (const auto vertex : triangle) facet.push_back(flat.vertices[vertex].head<2>());
      for (const RoofPlane& other : building.roof)
        if (&other != &plane) facet = clip_where_lower(facet, plane, other);
      const auto lifted = [&](std::size_t i) { return Eigen::Vector3d(facet[i].x(), facet[i].y(), plane.height(facet[i])); };
      for (std::size_t i = 1; i + 1 < facet.size(); ++i) append_triangle(mesh, lifted(0), lifted(i), lifted(i + 1));
    }
}

void append_chimney(TriangleMesh& mesh, const Building& building, Random& random) {
  constexpr double side_m = 0.6, sunk_m = 0.8, above_roof_m = 1.2;
  if (building.roof_shape == RoofShape::flat) return;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : building.outline.exterior) middle += p;
  middle /= static_cast<double>(building.outline.exterior.size());
  if (!contains(building.outline, middle)) return;
  const double yaw = random.uniform(0, 3);
  append_box(mesh, upright({middle.x(), middle.y(), building.roof_height(middle) - sunk_m}, yaw),
             {side_m, side_m, sunk_m + above_roof_m});
}

}  // namespace

void append_building(BuildingMeshes& meshes, const Building& building, Random random) {
  const auto append_ring = [&](const Ring2& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) append_wall(meshes, building, ring[i], ring[(i + 1) % ring.size()], random);
  };
  append_ring(building.outline.exterior);
  for (const Ring2& hole : building.outline.holes) append_ring(hole);
  append_roof(meshes.roof, building);
  append_chimney(meshes.walls, building, random);
}

}  // namespace priormap
