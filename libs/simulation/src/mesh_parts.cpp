#include "mesh_parts.hpp"

#include <cmath>
#include <numbers>

namespace priormap {

void append_triangle(TriangleMesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  constexpr double min_double_area_m2 = 1e-8;
  if ((b - a).cross(c - a).norm() < min_double_area_m2) return;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

void append_quad(TriangleMesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                 const Eigen::Vector3d& d) {
  append_triangle(mesh, a, b, c);
  append_triangle(mesh, a, c, d);
}

void append_box(TriangleMesh& mesh, const Eigen::Isometry3d& T_map_box, const Eigen::Vector3d& size) {
  const auto corner = [&](int i) {
    return Eigen::Vector3d(T_map_box * Eigen::Vector3d((i & 1 ? 0.5 : -0.5) * size.x(), (i & 2 ? 0.5 : -0.5) * size.y(),
                                                       i & 4 ? size.z() : 0.0));
  };
  constexpr int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) append_quad(mesh, corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
}

void append_cylinder(TriangleMesh& mesh, const Eigen::Vector3d& foot, double radius_m, double height_m, int sides) {
  const Eigen::Vector3d up = height_m * Eigen::Vector3d::UnitZ();
  const auto rim = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    return Eigen::Vector3d(foot + radius_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
  };
  for (int i = 0; i < sides; ++i) {
    append_quad(mesh, rim(i), rim(i + 1), rim(i + 1) + up, rim(i) + up);
    append_triangle(mesh, foot + up, rim(i) + up, rim(i + 1) + up);
  }
}

Eigen::Isometry3d upright(const Eigen::Vector3d& position, double yaw) {
  Eigen::Isometry3d T_map_object = Eigen::Isometry3d::Identity();
  T_map_object.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T_map_object.translation() = position;
  return T_map_object;
}

}  // namespace priormap
