#pragma once
#include <Eigen/Geometry>

#include <priormap/tessellation/surface.hpp>

namespace priormap {

void append_triangle(TriangleMesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
void append_quad(TriangleMesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                 const Eigen::Vector3d& d);
/// Box of the given size, its lower face centred on T_map_box's origin.
void append_box(TriangleMesh& mesh, const Eigen::Isometry3d& T_map_box, const Eigen::Vector3d& size);
/// Upright prism with `sides` faces and a lid.
void append_cylinder(TriangleMesh& mesh, const Eigen::Vector3d& foot, double radius_m, double height_m, int sides);
/// Frame at `position`, x axis at `yaw` counter-clockwise from east, z up.
Eigen::Isometry3d upright(const Eigen::Vector3d& position, double yaw);

}  // namespace priormap
