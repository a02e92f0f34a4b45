#include <priormap/tessellation/surface.hpp>

#include <Eigen/Geometry>
#include <map>

#include <priormap/tessellation/triangulate.hpp>

namespace priormap {

void TriangleMesh::append(const TriangleMesh& other) {
  const auto shift = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) triangles.push_back({a + shift, b + shift, c + shift});
}

double area(const TriangleMesh& mesh) {
  double twice = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    twice += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  return 0.5 * twice;
}

double enclosed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Eigen::Vector3d anchor = mesh.vertices.front();
  double six_fold = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    six_fold += (mesh.vertices[a] - anchor).dot((mesh.vertices[b] - anchor).cross(mesh.vertices[c] - anchor));
  return six_fold / 6;
}

std::vector<Surface> to_surfaces(std::span<const Face> faces) {
  std::map<SurfaceClass, Surface> by_class;
  for (const Face& face : faces) {
    Surface& surface = by_class[face.surface_class];
    surface.surface_class = face.surface_class;
    surface.mesh.append(triangulate(face.polygon));
  }
  std::vector<Surface> surfaces;
  for (auto& [surface_class, surface] : by_class) surfaces.push_back(std::move(surface));
  return surfaces;
}

}  // namespace priormap
