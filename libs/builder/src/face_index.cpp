#include "face_index.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include <priormap/pointcloud/slope.hpp>

#include "joints.hpp"

namespace priormap {
namespace {

constexpr double longest_face_m = 1000;      // a longer one is no building's, and would fill the index
constexpr double farthest_m = 2'000'000;     // 32 bits of millimetres
constexpr double inset_m = 0.01;             // points on a face's edge are judged by the face beside them, not by what lies beyond it
constexpr double same_place_m = 0.005;       // the lattice, and what writers round
constexpr double same_direction = 0.99;      // cosine

Eigen::AlignedBox3d box_of(const Ring3& ring) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : ring) box.extend(p);
  return box;
}

Eigen::Vector3d middle_of(const Ring3& ring) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : ring) sum += p - ring.front();
  return ring.front() + sum / static_cast<double>(ring.size());
}

}  // namespace

void FaceIndex::add(std::uint32_t model, const std::vector<ModelFace>& faces) {
  const std::set<SolidKey> closed = closed_solids(faces);
  std::map<SolidKey, std::uint32_t> solid_of_key;
  const auto first_face = static_cast<std::uint32_t>(faces_.size());
  for (const ModelFace& face : faces) {
    if (face.surface_class == SurfaceClass::closure) continue;
    const auto [solid, is_new] = solid_of_key.try_emplace(face.solid, static_cast<std::uint32_t>(solids_.size()));
    if (is_new) solids_.push_back({model, face.solid, closed.contains(face.solid)});
    add(face, solid->second);
  }
  if (std::ranges::any_of(faces, &ModelFace::repeated)) find_repetitions(first_face);
}

void FaceIndex::find_repetitions(std::uint32_t first_face) {
  const auto sorted_vertices = [&](const IndexedFace& face) {
    std::vector<std::array<int, 3>> vertices;
    for (std::uint32_t v = face.first; v < face.end; ++v) vertices.push_back({vertices_mm_[v].x(), vertices_mm_[v].y(), vertices_mm_[v].z()});
    std::ranges::sort(vertices);
    const auto repeated = std::ranges::unique(vertices);   // rings are closed, and may begin anywhere
    vertices.erase(repeated.begin(), repeated.end());
    return vertices;
  };
  std::map<std::vector<std::array<int, 3>>, std::vector<std::uint32_t>> shapes;
  for (std::uint32_t i = first_face; i < faces_.size(); ++i) {
    std::vector<std::uint32_t>& alike = shapes[sorted_vertices(faces_[i])];
    const auto same = std::ranges::find_if(alike, [&](std::uint32_t other) { return faces_[other].normal.dot(faces_[i].normal) > 0; });
    if (same == alike.end()) alike.push_back(i);
    else faces_[i].shape = *same;
  }
}

void FaceIndex::add(const ModelFace& face, std::uint32_t solid) {
  const Ring3& exterior = face.polygon.exterior;
  const Eigen::AlignedBox3d box = box_of(exterior);
  if (exterior.size() < 3 || !(box.diagonal().head<2>().norm() <= longest_face_m)) return;
  if (!has_origin_) {
    origin_ = exterior.front().array().round();
    has_origin_ = true;
  }
  if (!((box.min() - origin_).cwiseAbs().maxCoeff() < farthest_m && (box.max() - origin_).cwiseAbs().maxCoeff() < farthest_m)) return;

  IndexedFace indexed{face.normal.cast<float>(), static_cast<std::uint32_t>(vertices_mm_.size()), 0, solid, static_cast<std::uint32_t>(faces_.size()), face.repeated};
  const auto add_vertex = [&](const Eigen::Vector3d& p) { vertices_mm_.push_back((1e3 * (p - origin_)).array().round().cast<int>()); };
  const auto add_ring = [&](const Ring3& ring) {
    for (const Eigen::Vector3d& p : ring) add_vertex(p);
    add_vertex(ring.front());
  };
  add_ring(exterior);
  for (const Ring3& hole : face.polygon.holes) {
    if (hole.empty()) continue;
    add_ring(hole);
    add_vertex(exterior.front());   // the way there and back cancels in the even-odd rule
  }
  indexed.end = static_cast<std::uint32_t>(vertices_mm_.size());
  index_.add({box.min().x(), box.min().y(), box.max().x(), box.max().y()}, static_cast<std::uint32_t>(faces_.size()));
  faces_.push_back(indexed);
}

/// A face near the one asked about, and how they belong together.
struct FaceIndex::Candidate {
  const IndexedFace* face;
  Eigen::Vector3d normal, anchor;       // from the index's origin
  Eigen::Vector2d low, high;            // of its plan
  bool same_body;   // of the same solid, or of the same part, which one of the two bounds without a solid
  bool is_own;      // of the same body, or of a solid that has a face in common with it: the two sides of a sheet may be of both
  bool repeats;     // built with a later solid of the same building
  bool closed;      // of a solid that encloses a space
};

std::vector<FaceIndex::Candidate> FaceIndex::candidates(std::uint32_t model, const ModelFace& face) const {
  const Eigen::AlignedBox3d box = box_of(face.polygon.exterior);
  std::vector<Candidate> found;
  for (const std::uint32_t i : index_.meeting(grown({box.min().x(), box.min().y(), box.max().x(), box.max().y()}, joint_m))) {
    const IndexedFace& other = faces_[i];
    const Solid& solid = solids_[other.solid];
    const bool same_model = solid.model == model, same_part = same_model && solid.key.part == face.solid.part, in_solids = solid.key.solid != 0 && face.solid.solid != 0;
    const bool same_body = same_part && (!in_solids || solid.key.solid == face.solid.solid);
    const bool is_later = same_model && (solid.key.part > face.solid.part || (same_part && in_solids && solid.key.solid > face.solid.solid));
    Candidate candidate{&other, other.normal.cast<double>(), vertex(other.first), {}, {}, same_body, false, is_later && !other.repeated, solid.closed};
    const bool may_touch = !face.planar || std::abs(candidate.normal.dot(face.normal)) > same_direction;
    if (!may_touch && !candidate.closed) continue;
    candidate.low = candidate.high = candidate.anchor.head<2>();
    for (std::uint32_t v = other.first; v < other.end; ++v) {
      candidate.low = candidate.low.cwiseMin(vertex(v).head<2>());
      candidate.high = candidate.high.cwiseMax(vertex(v).head<2>());
    }
    found.push_back(candidate);
  }
  std::set<std::uint32_t> own_shapes;
  for (const Candidate& candidate : found)
    if (candidate.same_body) own_shapes.insert(candidate.face->shape);
  std::set<std::uint32_t> with_own_shapes;
  for (const Candidate& candidate : found)
    if (own_shapes.contains(candidate.face->shape)) with_own_shapes.insert(candidate.face->solid);
  for (Candidate& candidate : found) candidate.is_own = candidate.same_body || with_own_shapes.contains(candidate.face->solid);
  std::ranges::stable_sort(found, {}, [](const Candidate& candidate) { return candidate.face->solid; });
  return found;
}

/// A point of a face, and whether one of the candidates hides it.
class FaceIndex::Spot {
 public:
  /// @param place  from the index's origin. @param middle  of its face, likewise
  Spot(const FaceIndex& index, const Eigen::Vector3d& place, const Eigen::Vector3d& normal, const Eigen::Vector3d& middle) : index_(index), place_(place), normal_(normal) {
    const Eigen::Vector3d to_middle = middle - place;
    if (const double distance = to_middle.norm(); distance > inset_m) place_ += to_middle * (inset_m / distance);
    in_front_ = place_ + touching_m * normal;
  }

  /// Whether the other face lies on this spot: looking the other way, or, of a later solid, the same way.
  bool is_covered_by(const Candidate& candidate) const {
    const double cosine = candidate.normal.dot(normal_), in_front_of_it = candidate.normal.dot(place_ - candidate.anchor);
    if (cosine > same_direction) return candidate.repeats && std::abs(in_front_of_it) < same_place_m && is_on(candidate);
    // The back of a thin wall looks the other way too, and touches nothing.
    const double least = candidate.is_own ? -same_place_m : -touching_m;
    const bool is_parallel = 1 - cosine * cosine < joint_sine * joint_sine;
    const double most = !candidate.is_own && is_parallel && is_upright() ? joint_m : touching_m;
    return cosine < -same_direction && least < in_front_of_it && in_front_of_it < most && is_on(candidate);
  }

  bool is_upright() const { return is_wall(normal_.z()); }

  /// Whether the space in front lies inside the solid of these faces: above it one more looks up than down, below one more down.
  bool is_held_by(std::span<const Candidate> solid) const {
    int above = 0, below = 0;
    for (const Candidate& face : solid) {
      const bool upright = std::abs(face.normal.z()) < 1e-6;
      if (upright || !within(face, in_front_) || !is_inside(*face.face, {in_front_.x(), in_front_.y()}, {1, 0, 0}, {0, 1, 0})) continue;
      const double z = face.anchor.z() - face.normal.head<2>().dot(in_front_.head<2>() - face.anchor.head<2>()) / face.normal.z();
      (z > in_front_.z() ? above : below) += face.normal.z() > 0 ? 1 : -1;
    }
    return above > 0 && below < 0;
  }

 private:
  static bool within(const Candidate& candidate, const Eigen::Vector3d& place) {
    return (place.head<2>().array() >= candidate.low.array()).all() && (place.head<2>().array() <= candidate.high.array()).all();
  }

  /// Even-odd in the face's own plane: upright ones along the wall and upward, others from above.
  bool is_on(const Candidate& candidate) const {
    const Eigen::Vector3d& n = candidate.normal;
    if (!is_wall(n.z())) return within(candidate, place_) && is_inside(*candidate.face, place_.head<2>(), {1, 0, 0}, {0, 1, 0});
    const Eigen::Vector3d along = Eigen::Vector3d(-n.y(), n.x(), 0).normalized();
    return is_inside(*candidate.face, {along.dot(place_), place_.z()}, along, {0, 0, 1});
  }

  /// Even-odd over the plane that u and v span; a ray along v crosses the edges of all rings.
  bool is_inside(const IndexedFace& face, const Eigen::Vector2d& place, const Eigen::Vector3d& u, const Eigen::Vector3d& v) const {
    bool inside = false;
    for (std::uint32_t i = face.first; i + 1 < face.end; ++i) {
      const Eigen::Vector3d a = index_.vertex(i), b = index_.vertex(i + 1);
      const double ua = u.dot(a), ub = u.dot(b), va = v.dot(a), vb = v.dot(b);
      if ((ua > place.x()) != (ub > place.x()) && place.y() < va + (place.x() - ua) / (ub - ua) * (vb - va)) inside = !inside;
    }
    return inside;
  }

  const FaceIndex& index_;
  Eigen::Vector3d place_, normal_, in_front_;
};

void FaceIndex::remove_hidden(std::uint32_t model, const ModelFace& face, std::vector<Eigen::Vector3d>& points, std::vector<Eigen::Vector3d>& normals) const {
  const std::vector<Candidate> near = candidates(model, face);
  std::vector<std::span<const Candidate>> solids;
  for (auto first = near.begin(); first != near.end();) {
    const auto end = std::find_if(first, near.end(), [&](const Candidate& candidate) { return candidate.face->solid != first->face->solid; });
    solids.emplace_back(first, end);
    first = end;
  }
  const auto is_hidden_by = [](const Spot& spot, std::span<const Candidate> solid) {
    const Candidate& any = solid.front();
    const bool covered = std::ranges::any_of(solid, [&](const Candidate& candidate) { return spot.is_covered_by(candidate); });
    if (!any.same_body) return covered || (any.closed && spot.is_held_by(solid));
    // Both sides of a sheet, such as eaves, look away from each other too: in front of blocks that touch there is no air.
    return covered && (any.closed ? spot.is_held_by(solid) : spot.is_upright());
  };
  const Eigen::Vector3d middle = middle_of(face.polygon.exterior) - origin_;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Spot spot(*this, points[i] - origin_, normals[i], middle);
    if (std::ranges::any_of(solids, [&](std::span<const Candidate> solid) { return is_hidden_by(spot, solid); })) continue;
    points[kept] = points[i];
    normals[kept++] = normals[i];
  }
  points.resize(kept);
  normals.resize(kept);
}

}  // namespace priormap
