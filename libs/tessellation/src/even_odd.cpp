#include "even_odd.hpp"

#include <CGAL/Constrained_triangulation_plus_2.h>

#include <algorithm>
#include <map>
#include <set>

#include "constrained_triangulation.hpp"

namespace priormap {
namespace {

// Remembers which constraints run along an edge, so that edges that lie on each other cancel.
using Arrangement = CGAL::Constrained_triangulation_plus_2<Cdt>;
using Vertex = Cdt::Vertex_handle;
using Face = Cdt::Face_handle;
using Edge = Cdt::Edge;  // face and index of the opposite vertex; here always an inside face

bool smaller(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); }

bool is_boundary(const Arrangement& arrangement, const Edge& edge) {
  const auto& [face, i] = edge;
  if (!arrangement.is_constrained(edge)) return false;
  return arrangement.number_of_enclosing_constraints(face->vertex(Cdt::ccw(i)), face->vertex(Cdt::cw(i))) % 2 == 1;
}

int label_components(Arrangement& cdt) {
  int components = 0;
  std::vector<Face> stack;
  for (auto seed : cdt.finite_face_handles()) {
    if (!seed->info().inside || seed->info().component != -1) continue;
    stack.push_back(seed);
    while (!stack.empty()) {
      const Face face = stack.back();
      stack.pop_back();
      if (face->info().component != -1) continue;
      face->info().component = components;
      for (int i = 0; i < 3; ++i)
        if (!is_boundary(cdt, {face, i}) && face->neighbor(i)->info().component == -1) stack.push_back(face->neighbor(i));
    }
    ++components;
  }
  return components;
}

/// The boundary edge that follows `edge` with the same stretch of inside on its left: turn about the edge's end through inside faces.
Edge next_boundary_edge(const Arrangement& cdt, const Edge& edge) {
  Face face = edge.first;
  const Vertex pivot = face->vertex(Cdt::cw(edge.second));
  int i = Cdt::cw(face->index(pivot));  // the edge that leaves the pivot is opposite to this vertex
  while (!is_boundary(cdt, {face, i})) {
    face = face->neighbor(i);
    i = Cdt::cw(face->index(pivot));
  }
  return {face, i};
}

/// Splits a closed walk that meets a vertex twice into loops that do not.
std::vector<Ring2> split_at_repeated_vertices(const std::vector<Vertex>& walk) {
  std::vector<Ring2> rings;
  std::vector<Vertex> path;
  std::set<Vertex> on_path;
  const auto close_loop = [&](std::size_t start) {
    Ring2 ring;
    for (std::size_t i = start; i < path.size(); ++i) {
      ring.emplace_back(path[i]->point().x(), path[i]->point().y());
      on_path.erase(path[i]);
    }
    path.resize(start);
    if (ring.size() >= 3) rings.push_back(std::move(ring));
  };
  for (const Vertex vertex : walk) {
    if (on_path.contains(vertex)) close_loop(static_cast<std::size_t>(std::find(path.begin(), path.end(), vertex) - path.begin()));
    path.push_back(vertex);
    on_path.insert(vertex);
  }
  close_loop(0);
  for (Ring2& ring : rings) std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), smaller), ring.end());
  return rings;
}

void add_ring(std::vector<Polygon2>& polygons, Ring2 ring) {
  if (signed_area(ring) > 0) polygons.push_back({std::move(ring), {}});
}

}  // namespace

std::vector<Polygon2> even_odd_polygons(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& edges) {
  Arrangement cdt;
  for (const auto& [a, b] : edges) {
    const Vertex va = cdt.insert(Kernel::Point_2(a.x(), a.y())), vb = cdt.insert(Kernel::Point_2(b.x(), b.y()));
    if (va != vb) cdt.insert_constraint(va, vb);
  }
  if (cdt.dimension() < 2) return {};
  label_inside(cdt, [&](const Edge& edge) { return is_boundary(cdt, edge); });

  std::vector<std::vector<Ring2>> rings_of(static_cast<std::size_t>(label_components(cdt)));
  std::set<std::pair<Face, int>> visited;
  for (auto face : cdt.finite_face_handles()) {
    for (int i = 0; i < 3; ++i) {
      if (!face->info().inside || !is_boundary(cdt, {face, i}) || visited.contains({face, i})) continue;
      std::vector<Vertex> walk;
      for (Edge edge{face, i}; visited.insert({edge.first, edge.second}).second; edge = next_boundary_edge(cdt, edge))
        walk.push_back(edge.first->vertex(Cdt::ccw(edge.second)));
      auto& rings = rings_of[static_cast<std::size_t>(face->info().component)];
      std::ranges::move(split_at_repeated_vertices(walk), std::back_inserter(rings));
    }
  }

  std::vector<Polygon2> polygons;
  for (std::vector<Ring2>& rings : rings_of) {
    const std::size_t first = polygons.size();
    for (const Ring2& ring : rings) add_ring(polygons, ring);
    for (Ring2& ring : rings) {
      if (signed_area(ring) >= 0) continue;
      for (std::size_t i = first; i < polygons.size(); ++i) {
        if (polygons.size() > first + 1 && !contains(polygons[i].exterior, ring.front())) continue;
        polygons[i].holes.push_back(std::move(ring));
        break;
      }
    }
  }
  for (Polygon2& polygon : polygons)
    std::ranges::sort(polygon.holes, [](const Ring2& a, const Ring2& b) { return smaller(a.front(), b.front()); });
  std::ranges::sort(polygons, [](const Polygon2& a, const Polygon2& b) { return smaller(a.exterior.front(), b.exterior.front()); });
  return polygons;
}

}  // namespace priormap
