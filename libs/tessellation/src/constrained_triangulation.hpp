#pragma once
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cstdint>
#include <vector>

namespace priormap {

struct FaceLabel {
  bool reached = false, inside = false;
  int component = -1;  ///< of the inside, connected across edges
};

/// Vertices that CGAL makes where constraints cross keep `none`: it leaves a plain number uninitialised.
struct VertexNumber {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t value = none;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexNumber, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<FaceLabel, Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                                       CGAL::Exact_predicates_tag>;

/// Labels each face as inside or outside by the even-odd rule: stepping over an edge for which `is_boundary` holds changes sides.
template <class Triangulation, class IsBoundary>
void label_inside(Triangulation& triangulation, const IsBoundary& is_boundary) {
  for (auto face : triangulation.all_face_handles()) face->info() = FaceLabel{};
  std::vector<typename Triangulation::Face_handle> stack{triangulation.infinite_face()};
  stack.back()->info().reached = true;
  while (!stack.empty()) {
    const auto face = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const auto neighbor = face->neighbor(i);
      if (neighbor->info().reached) continue;
      neighbor->info().reached = true;
      neighbor->info().inside = face->info().inside != is_boundary(typename Triangulation::Edge(face, i));
      stack.push_back(neighbor);
    }
  }
}

}  // namespace priormap
