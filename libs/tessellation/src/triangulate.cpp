#include <priormap/tessellation/triangulate.hpp>

#include <Eigen/Geometry>

#include "constrained_triangulation.hpp"
#include "plane_frame.hpp"

namespace priormap {
namespace {

/// Inserts the edges of a ring as constraints; its vertices are numbered from `first_number` on.
void insert_ring(Cdt& cdt, const Ring2& ring, std::uint32_t first_number) {
  if (ring.empty()) return;
  std::vector<Cdt::Vertex_handle> handles;
  handles.reserve(ring.size());
  for (const Eigen::Vector2d& p : ring) {
    const auto hint = handles.empty() ? Cdt::Face_handle() : handles.back()->face();
    const std::size_t before = cdt.number_of_vertices();
    handles.push_back(cdt.insert(Kernel::Point_2(p.x(), p.y()), hint));
    // A vertex that coincides with an earlier one keeps that one's number.
    if (cdt.number_of_vertices() > before) handles.back()->info().value = first_number + static_cast<std::uint32_t>(handles.size() - 1);
  }
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const auto a = handles[i], b = handles[i + 1 == handles.size() ? 0 : i + 1];
    if (a != b) cdt.insert_constraint(a, b);
  }
}

TriangleMesh triangulate_flat(const Polygon2& polygon) {
  Cdt cdt;
  TriangleMesh mesh;
  for_each_ring(polygon, [&](const Ring2& ring) {
    insert_ring(cdt, ring, static_cast<std::uint32_t>(mesh.vertices.size()));
    for (const Eigen::Vector2d& p : ring) mesh.vertices.emplace_back(p.x(), p.y(), 0);
  });
  if (cdt.dimension() < 2) return {};
  label_inside(cdt, [&](const Cdt::Edge& edge) { return cdt.is_constrained(edge); });
  for (auto vertex : cdt.finite_vertex_handles()) {
    if (vertex->info().value != VertexNumber::none) continue;
    vertex->info().value = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(vertex->point().x(), vertex->point().y(), 0);
  }
  for (auto face : cdt.finite_face_handles())
    if (face->info().inside)
      mesh.triangles.push_back({face->vertex(0)->info().value, face->vertex(1)->info().value, face->vertex(2)->info().value});
  return mesh;
}

bool is_convex_ring(const Ring2& ring) {
  for (std::size_t i = 0, n = ring.size(); i < n; ++i) {
    const Eigen::Vector2d a = ring[(i + 1) % n] - ring[i], b = ring[(i + 2) % n] - ring[(i + 1) % n];
    if (a.x() * b.y() - a.y() * b.x() <= 0) return false;
  }
  return true;
}

/// Walls and most roofs are convex quadrilaterals: no need for a triangulation.
bool is_convex_quadrilateral(const Polygon2& polygon) {
  return polygon.holes.empty() && polygon.exterior.size() == 4 && is_convex_ring(polygon.exterior);
}

TriangleMesh two_triangles(const Ring2& ring) {
  TriangleMesh mesh;
  for (const Eigen::Vector2d& p : ring) mesh.vertices.emplace_back(p.x(), p.y(), 0);
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

}  // namespace

TriangleMesh triangulate(const Polygon2& polygon) {
  return is_convex_quadrilateral(polygon) ? two_triangles(polygon.exterior) : triangulate_flat(polygon);
}

TriangleMesh triangulate(const Polygon3& polygon, double* max_deviation_m) {
  if (max_deviation_m) *max_deviation_m = 0;
  const std::optional<PlaneFrame> frame = PlaneFrame::of(polygon);
  if (!frame) return {};
  Polygon2 flat;
  std::vector<Eigen::Vector3d> vertices;
  double deviation = 0;
  const auto flatten = [&](const Ring3& ring) {
    Ring2 flat_ring;
    for (const Eigen::Vector3d& p : ring) {
      flat_ring.push_back(frame->to_plane(p));
      deviation = std::max(deviation, std::abs(frame->height(p)));
      vertices.push_back(p);
    }
    return flat_ring;
  };
  flat.exterior = flatten(polygon.exterior);
  for (const Ring3& hole : polygon.holes) flat.holes.push_back(flatten(hole));
  if (max_deviation_m) *max_deviation_m = deviation;

  TriangleMesh mesh = triangulate(flat);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.vertices[i] = i < vertices.size() ? vertices[i] : frame->to_space(mesh.vertices[i].head<2>());
  return mesh;
}

}  // namespace priormap
