#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/create_straight_skeleton_2.h>

#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <set>

#include <priormap/tessellation/clip.hpp>

#include "roof_kinds.hpp"

namespace priormap {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Skeleton = CGAL::Straight_skeleton_2<Kernel>;
using Halfedge = Skeleton::Halfedge_const_handle;
using Vertex = Skeleton::Vertex_const_handle;

constexpr std::size_t most_vertices = 200;  // the skeleton takes more than quadratic time

using PointKey = std::array<double, 2>;
PointKey key(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }
Eigen::Vector2d point(const Vertex& vertex) { return {vertex->point().x(), vertex->point().y()}; }

bool rings_share_a_point(const Polygon2& outline) {
  std::set<PointKey> seen;
  bool shared = false;
  for_each_ring(outline, [&](const Ring2& ring) { for (const Eigen::Vector2d& p : ring) shared |= !seen.insert(key(p)).second; });
  return shared;
}

std::size_t num_vertices(const Polygon2& outline) {
  std::size_t n = 0;
  for_each_ring(outline, [&](const Ring2& ring) { n += ring.size(); });
  return n;
}

CGAL::Polygon_2<Kernel> to_cgal(const Ring2& ring) {
  CGAL::Polygon_2<Kernel> polygon;
  for (const Eigen::Vector2d& p : ring) polygon.push_back({p.x(), p.y()});
  return polygon;
}

boost::shared_ptr<Skeleton> skeleton_of(const Polygon2& outline) {
  if (num_vertices(outline) > most_vertices || rings_share_a_point(outline)) return {};
  const CGAL::Polygon_2<Kernel> exterior = to_cgal(outline.exterior);
  std::vector<CGAL::Polygon_2<Kernel>> holes;
  for (const Ring2& hole : outline.holes) holes.push_back(to_cgal(hole));
  if (!exterior.is_simple() || !std::ranges::all_of(holes, [](const auto& hole) { return hole.is_simple(); })) return {};
  try {
    return CGAL::create_interior_straight_skeleton_2(exterior.vertices_begin(), exterior.vertices_end(), holes.begin(), holes.end(), Kernel());
  } catch (const std::exception&) {  // CGAL reports what it cannot do by its failure exceptions
    return {};
  }
}

/// The part of the roof that drains over one edge of the outline: `plan` lies on the inner side of the edge.
struct Slope {
  Eigen::Vector2d edge_start, edge_end;
  std::vector<Vertex> corners;   // edge start, edge end, and on
  LinearFunction distance() const {
    const Eigen::Vector2d along = (edge_end - edge_start).normalized(), inward(-along.y(), along.x());
    return {inward, -inward.dot(edge_start)};
  }
};

std::vector<Slope> slopes_of(const Skeleton& skeleton) {
  std::vector<Slope> slopes;
  for (auto face = skeleton.faces_begin(); face != skeleton.faces_end(); ++face) {
    Halfedge edge = face->halfedge();
    while (edge->is_bisector()) edge = edge->next();
    Slope slope{point(edge->opposite()->vertex()), point(edge->vertex()), {}};
    Halfedge at = edge->prev();
    do {
      slope.corners.push_back(at->vertex());
      at = at->next();
    } while (at != edge->prev());
    slopes.push_back(std::move(slope));
  }
  return slopes;
}

/// The vertex at the other end of the ridge that ends in the apex of a triangular slope.
std::optional<Vertex> ridge_start(const Slope& triangle) {
  const Vertex apex = triangle.corners[2];
  std::optional<Vertex> start;
  Halfedge at = apex->halfedge();
  for (const Halfedge first = at;;) {
    const Vertex other = at->opposite()->vertex();
    if (other != triangle.corners[0] && other != triangle.corners[1]) {
      if (start) return std::nullopt;  // several ridges meet
      start = other;
    }
    at = at->next()->opposite();
    if (at == first) return start;
  }
}

/// Where the ridge that ends in the apex of a triangular slope meets the wall below it.
std::optional<Eigen::Vector2d> gable_top(const Slope& slope) {
  if (slope.corners.size() != 3) return std::nullopt;
  const std::optional<Vertex> start = ridge_start(slope);
  if (!start || (*start)->is_contour()) return std::nullopt;
  const Eigen::Vector2d apex = point(slope.corners[2]), ridge = apex - point(*start);
  const LinearFunction distance = slope.distance();
  const double approach = -distance.gradient.dot(ridge);
  if (!(approach > 0.1 * ridge.norm()) || ridge.norm() < 0.05) return std::nullopt;  // nearly parallel to the wall, or no ridge
  const Eigen::Vector2d top = apex + ridge * (distance(apex) / approach), along = slope.edge_end - slope.edge_start;
  const double t = (top - slope.edge_start).dot(along) / along.squaredNorm();
  return t > 0.05 && t < 0.95 ? std::optional(top) : std::nullopt;
}

/// Height over distance from the edge, both as shares of the greatest.
using Profile = std::vector<std::array<double, 2>>;

Profile profile_of(RoofShape shape) {
  if (shape == RoofShape::mansard) return {{0, 0}, {1.0 / 3, 2.0 / 3}, {1, 1}};
  return {{0, 0}, {1, 1}};
}

class SkeletonRoof {
 public:
  SkeletonRoof(const Skeleton& skeleton, double eaves_z, const RoofSpec& spec) : slopes_(slopes_of(skeleton)), eaves_z_(eaves_z), spec_(spec) {
    if (spec.shape == RoofShape::gabled)
      for (const Slope& slope : slopes_)
        if (const auto top = gable_top(slope)) moved_[slope.corners[2]] = *top;
    for (const Slope& slope : slopes_)
      for (const Vertex corner : slope.corners) run_m_ = std::max(run_m_, slope.distance()(place(corner)));
  }

  std::optional<Roof> build(const Polygon2& outline) const {
    if (!(run_m_ > 0)) return std::nullopt;
    Roof roof;
    std::map<std::pair<PointKey, PointKey>, Ring3> tops;
    for (const Slope& slope : slopes_) {
      Ring3& top = tops[{key(slope.edge_start), key(slope.edge_end)}];
      top = {at_eaves(slope.edge_start), at_eaves(slope.edge_end)};
      if (is_gable(slope)) top.insert(top.begin() + 1, gable_tip(slope));
      else add_faces(slope, roof.faces);
    }
    bool complete = true;
    for_each_ring(outline, [&](const Ring2& ring) {
      for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        const auto top = tops.find({key(a), key(b)});
        complete &= top != tops.end();
        if (top != tops.end()) roof.wall_tops.push_back(top->second);
      });
    });
    return complete ? std::optional(std::move(roof)) : std::nullopt;
  }

 private:
  Eigen::Vector2d place(const Vertex& vertex) const {
    const auto moved = moved_.find(vertex);
    return moved == moved_.end() ? point(vertex) : moved->second;
  }
  bool is_gable(const Slope& slope) const { return slope.corners.size() == 3 && moved_.contains(slope.corners[2]); }
  Eigen::Vector3d at_eaves(const Eigen::Vector2d& p) const { return {p.x(), p.y(), eaves_z_}; }

  /// The ridge's height there, from a slope beside the gable that shares its apex.
  Eigen::Vector3d gable_tip(const Slope& gable) const {
    const Vertex apex = gable.corners[2];
    const Eigen::Vector2d p = place(apex);
    const auto beside = std::ranges::find_if(slopes_, [&](const Slope& other) {
      return !is_gable(other) && std::ranges::find(other.corners, apex) != other.corners.end();
    });
    const double distance = beside == slopes_.end() ? 0 : beside->distance()(p);
    return {p.x(), p.y(), eaves_z_ + distance / run_m_ * spec_.rise_m};
  }

  void add_faces(const Slope& slope, std::vector<Polygon3>& faces) const {
    Polygon2 plan;
    for (const Vertex corner : slope.corners) plan.exterior.push_back(place(corner));
    const LinearFunction distance = slope.distance();
    const Profile profile = profile_of(spec_.shape);
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
      const auto [d0, h0] = profile[i];
      const auto [d1, h1] = profile[i + 1];
      std::vector<Polygon2> band{plan};
      if (i > 0) band = clip(band, {-distance.gradient, d0 * run_m_ - distance.offset});
      if (i + 2 < profile.size()) band = clip(band, {distance.gradient, distance.offset - d1 * run_m_});
      for (const Polygon2& piece : band) {
        Polygon3 face;
        for (const Eigen::Vector2d& p : piece.exterior) {
          const double share = distance(p) / run_m_;
          face.exterior.emplace_back(p.x(), p.y(), eaves_z_ + (h0 + (share - d0) / (d1 - d0) * (h1 - h0)) * spec_.rise_m);
        }
        faces.push_back(std::move(face));
      }
    }
  }

  std::vector<Slope> slopes_;
  std::map<Vertex, Eigen::Vector2d> moved_;
  double eaves_z_, run_m_ = 0;
  RoofSpec spec_;
};

Polygon2 shifted(Polygon2 outline, const Eigen::Vector2d& shift) {
  for_each_ring(outline, [&](Ring2& ring) { for (Eigen::Vector2d& p : ring) p += shift; });
  return outline;
}

}  // namespace

double skeleton_run_m(const Polygon2& outline) {
  const auto skeleton = skeleton_of(shifted(outline, -outline.exterior.front()));
  double run_m = 0;
  if (skeleton)
    for (auto vertex = skeleton->vertices_begin(); vertex != skeleton->vertices_end(); ++vertex) run_m = std::max(run_m, vertex->time());
  return run_m;
}

std::optional<Roof> skeleton_roof(const Polygon2& outline, double eaves_z, const RoofSpec& spec) {
  const Eigen::Vector2d anchor = outline.exterior.front();
  const Polygon2 local = shifted(outline, -anchor);  // small numbers keep the skeleton's digits
  const auto skeleton = skeleton_of(local);
  if (!skeleton) return std::nullopt;
  std::optional<Roof> roof = SkeletonRoof(*skeleton, eaves_z, spec).build(local);
  if (!roof) return std::nullopt;
  const Eigen::Vector3d shift(anchor.x(), anchor.y(), 0);
  for (Polygon3& face : roof->faces) for (Eigen::Vector3d& p : face.exterior) p += shift;
  for (Ring3& top : roof->wall_tops) for (Eigen::Vector3d& p : top) p += shift;
  return roof;
}

}  // namespace priormap
