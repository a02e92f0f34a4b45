#include "model_faces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include <priormap/pointcloud/slope.hpp>

namespace priormap {
namespace {

constexpr double planarity_m = 0.01;   // val3dity's --planarity_d2p_tol
constexpr double longest_face_m = 5000, largest_building_m2 = 10e6;   // all faces of one; each of a terrain model

/// Drops repeated points; false when fewer than three are left.
bool clean(Ring3& ring, const std::string& feature, Diagnostics& diagnostics) {
  const std::size_t before = ring.size();
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < before) diagnostics.add(DiagnosticCode::consecutive_points_same, feature, "repeated points");
  if (ring.size() >= 3) return true;
  diagnostics.add(DiagnosticCode::too_few_points, feature, std::to_string(ring.size()) + " points in a ring");
  return false;
}

Eigen::Vector3d middle_of(const Ring3& ring) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : ring) middle += p;
  return middle / static_cast<double>(ring.size());
}

double deviation_from_plane(const Polygon3& polygon, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d middle = middle_of(polygon.exterior);
  double deviation = 0;
  for_each_ring(polygon, [&](const Ring3& ring) {
    for (const Eigen::Vector3d& p : ring) deviation = std::max(deviation, std::abs(normal.dot(p - middle)));
  });
  return deviation;
}

/// What no building is, but a wrong digit makes: points for it would fill the memory.
bool is_implausible(const Polygon3& polygon, double area_m2) {
  Eigen::Vector3d low = polygon.exterior.front(), high = low;
  for (const Eigen::Vector3d& p : polygon.exterior) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return !((high - low).norm() <= longest_face_m && area_m2 <= largest_building_m2);
}

SurfaceClass class_by_slope(const Eigen::Vector3d& normal, ModelKind kind) {
  const SurfaceClass underside = kind == ModelKind::bridge ? SurfaceClass::outer_ceiling : SurfaceClass::ground_surface;
  return is_wall(normal.z()) ? SurfaceClass::wall : normal.z() > 0 ? SurfaceClass::roof : underside;
}

void turn_over(ModelFace& face) {
  for_each_ring(face.polygon, [](Ring3& ring) { std::reverse(ring.begin(), ring.end()); });
  face.normal = -face.normal;
}

/// Twice the integral over a face of places, from `anchor`, times the normal: the sum over the triangles that fan out from a corner of each ring.
Eigen::Matrix3d twice_moment_of(const Polygon3& polygon, const Eigen::Vector3d& anchor) {
  const auto of_ring = [&](const Ring3& ring) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for_each_edge(ring, [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      const Eigen::Vector3d& corner = ring.front();
      sum += ((corner + a + b) / 3 - anchor) * (a - corner).cross(b - corner).transpose();
    });
    return sum;
  };
  Eigen::Matrix3d moment = of_ring(polygon.exterior);
  const Eigen::Vector3d normal = newell_normal(polygon.exterior);
  for (const Ring3& hole : polygon.holes) moment += (newell_normal(hole).dot(normal) > 0 ? -1 : 1) * of_ring(hole);
  return moment;
}

/// Sums over the faces of a solid.
struct Solid {
  void add(const ModelFace& face) {
    const Eigen::Vector3d twice = newell_normal(face.polygon), middle = middle_of(face.polygon.exterior) - anchor;
    twice_vector_area += twice;
    twice_area += twice.norm();
    twice_moment += twice_moment_of(face.polygon, anchor);
    twice_distances += twice.norm() * middle.norm();
    six_volumes += twice.dot(middle);
  }
  Solid& operator+=(Solid other) {
    const Eigen::Vector3d middle = (twice_area * anchor + other.twice_area * other.anchor) / (twice_area + other.twice_area);
    measure_from(middle);
    other.measure_from(middle);
    twice_vector_area += other.twice_vector_area;
    twice_area += other.twice_area;
    twice_moment += other.twice_moment;
    twice_distances += other.twice_distances;
    six_volumes += other.six_volumes;
    return *this;
  }
  /// The distances become what they are at most.
  void measure_from(const Eigen::Vector3d& place) {
    const Eigen::Vector3d shift = anchor - place;
    twice_moment += shift * twice_vector_area.transpose();
    twice_distances += twice_area * shift.norm();
    six_volumes += twice_vector_area.dot(shift);
    anchor = place;
  }
  /// The vectors of area cancel where faces close a solid, and where what they leave open on one side they leave open on the other.
  bool vectors_cancel() const { return twice_vector_area.norm() < rounding * twice_area; }
  /// By the divergence theorem the moment of a closed surface is the volume times the unit matrix, however its faces meet: edges need not be the same on both
  /// sides, as in many models they are not. An open tube has none along itself.
  bool is_closed() const {
    const Eigen::Matrix3d of_volume = twice_moment.trace() / 3 * Eigen::Matrix3d::Identity();
    return vectors_cancel() && (twice_moment - of_volume).norm() < rounding * twice_distances;
  }
  /// Only where the vectors cancel the volume does not depend on the anchor.
  bool looks_inward() const {
    constexpr double least_thickness = 1e-6;
    return vectors_cancel() && six_volumes < -least_thickness * std::pow(twice_area, 1.5);
  }

  static constexpr double rounding = 1e-3;
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();   ///< in the middle of the solid: what counts as rounding grows with the distances from it
  Eigen::Vector3d twice_vector_area = Eigen::Vector3d::Zero();
  Eigen::Matrix3d twice_moment = Eigen::Matrix3d::Zero();
  double twice_area = 0, twice_distances = 0, six_volumes = 0;
};

std::map<SolidKey, Solid> solids_of(const std::vector<ModelFace>& faces) {
  std::map<SolidKey, Solid> solids;
  std::map<SolidKey, double> num_faces;
  for (const ModelFace& face : faces) {
    Eigen::Vector3d& middle = solids[face.solid].anchor;
    middle += (middle_of(face.polygon.exterior) - middle) / ++num_faces[face.solid];
  }
  for (const ModelFace& face : faces) solids[face.solid].add(face);
  return solids;
}

/// A party wall that two solids refer to alike looks into one of them: turned over where that closes the solid. Of one that stays open nothing can be told.
/// @param shared  by face
void turn_shared_faces(std::vector<ModelFace>& faces, const std::vector<bool>& shared) {
  if (std::ranges::find(shared, true) == shared.end()) return;
  std::map<SolidKey, std::vector<std::size_t>> shared_of;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (shared[i]) shared_of[faces[i].solid].push_back(i);
  for (auto& [key, solid] : solids_of(faces)) {
    std::set<std::size_t> turned;
    constexpr int passes = 4;   // a wall in pieces, of which some are turned already
    for (int pass = 0; pass < passes && !solid.vectors_cancel(); ++pass)
      for (const std::size_t i : shared_of[key]) {
        const bool is_turned = turned.contains(i);
        const Eigen::Vector3d twice = (is_turned ? -1 : 1) * newell_normal(faces[i].polygon);
        if (!(solid.twice_vector_area.dot(twice) > twice.squaredNorm())) continue;   // nearer to closed as it is
        solid.twice_vector_area -= 2 * twice;
        if (is_turned) turned.erase(i);
        else turned.insert(i);
      }
    if (!solid.vectors_cancel()) continue;
    for (const std::size_t i : turned) turn_over(faces[i]);
  }
}

/// Some solids leave out faces that their part states beside them, such as windows: what closes one open solid of a part, and no other, belongs to it.
void close_solids(std::vector<ModelFace>& faces) {
  std::map<SolidKey, Solid> solids = solids_of(faces);
  std::map<int, std::vector<SolidKey>> open_of_part;
  for (const auto& [key, solid] : solids)
    if (key.solid != 0 && !solid.is_closed()) open_of_part[key.part].push_back(key);
  for (const auto& [part, open] : open_of_part) {
    const SolidKey beside{part, 0};
    if (!solids.contains(beside)) continue;
    std::vector<SolidKey> closed_by_it;
    std::ranges::copy_if(open, std::back_inserter(closed_by_it), [&](const SolidKey& key) {
      Solid both = solids[key];
      both += solids[beside];
      return both.is_closed();
    });
    if (closed_by_it.size() != 1) continue;
    for (ModelFace& face : faces)
      if (face.solid == beside) face.solid = closed_by_it.front();
  }
}

void turn_solids_outward(std::vector<ModelFace>& faces, const std::string& feature, Diagnostics& diagnostics) {
  for (const auto& [key, solid] : solids_of(faces)) {
    if (!solid.looks_inward()) continue;
    diagnostics.add(DiagnosticCode::polygon_wrong_orientation, feature, "a solid whose faces look inward");
    for (ModelFace& face : faces)
      if (face.solid == key) turn_over(face);
  }
}

/// Single faces: what they are, and that roofs look up.
void name_and_turn(ModelFace& face, const BuildingModel& model, Diagnostics& diagnostics) {
  const bool looks_up_by_kind = face.surface_class == SurfaceClass::roof || face.surface_class == SurfaceClass::terrain;
  if (looks_up_by_kind && face.normal.z() < -0.1) {
    diagnostics.add(DiagnosticCode::polygon_wrong_orientation, model.id, "a roof that looks down");
    turn_over(face);
  }
  if (face.surface_class == SurfaceClass::unclassified) face.surface_class = class_by_slope(face.normal, model.kind);
}

}  // namespace

std::vector<ModelFace> model_faces(const BuildingModel& model, Diagnostics& diagnostics) {
  std::vector<ModelFace> faces;
  std::vector<bool> shared;
  faces.reserve(model.polygons.size());
  double total_m2 = 0;
  Diagnostics counted_already;
  for (const ModelPolygon& stated : model.polygons) {
    Diagnostics& counts = stated.repeated ? counted_already : diagnostics;
    if (!stated.closed) counts.add(DiagnosticCode::ring_not_closed, model.id, "a ring does not repeat its first point");
    ModelFace face{stated.polygon, Eigen::Vector3d::Zero(), stated.surface_class, {stated.part, stated.solid}, stated.repeated};
    if (!clean(face.polygon.exterior, model.id, counts)) continue;
    std::erase_if(face.polygon.holes, [&](Ring3& hole) { return !clean(hole, model.id, counts); });
    const Eigen::Vector3d twice_area = newell_normal(face.polygon);
    if (!(twice_area.norm() > 1e-6)) {
      counts.add(DiagnosticCode::degenerate_geometry, model.id, "a polygon without area");
      continue;
    }
    const double area_m2 = 0.5 * twice_area.norm();
    if (is_implausible(face.polygon, total_m2 + area_m2)) {
      counts.add(DiagnosticCode::implausible_size, model.id, "larger than any building; left out");
      continue;
    }
    if (model.kind != ModelKind::terrain && !stated.repeated) total_m2 += area_m2;
    face.normal = twice_area.normalized();
    const double deviation = deviation_from_plane(face.polygon, face.normal);
    face.planar = deviation <= planarity_m;
    if (!face.planar) counts.add(DiagnosticCode::non_planar_polygon, model.id, std::to_string(deviation) + " m from its plane");
    faces.push_back(std::move(face));
    shared.push_back(stated.shared);
  }
  if (model.kind != ModelKind::terrain) {
    turn_shared_faces(faces, shared);
    close_solids(faces);
    turn_solids_outward(faces, model.id, diagnostics);
  }
  for (ModelFace& face : faces) name_and_turn(face, model, face.repeated ? counted_already : diagnostics);
  return faces;
}

std::set<SolidKey> closed_solids(const std::vector<ModelFace>& faces) {
  std::set<SolidKey> closed;
  for (const auto& [key, solid] : solids_of(faces))
    if (solid.is_closed()) closed.insert(key);
  for (const ModelFace& face : faces)
    if (face.surface_class == SurfaceClass::closure) closed.erase(face.solid);
  return closed;
}

bool can_be_seen(const ModelFace& face, ModelKind kind) {
  const bool is_bridge = kind == ModelKind::bridge;
  switch (face.surface_class) {
    case SurfaceClass::ground_surface: case SurfaceClass::closure: return false;
    case SurfaceClass::outer_floor: case SurfaceClass::outer_ceiling: return is_bridge;
    case SurfaceClass::terrain: return true;
    default: return is_bridge || face.normal.z() > -0.7;
  }
}

std::vector<std::vector<std::vector<Eigen::Vector2d>>> footprint_of(const std::vector<ModelFace>& faces) {
  const auto outlines_of = [&](SurfaceClass surface_class) {
    std::vector<std::vector<std::vector<Eigen::Vector2d>>> outlines;
    for (const ModelFace& face : faces) {
      if (face.repeated || face.surface_class != surface_class || std::abs(face.normal.z()) < 0.1) continue;
      std::vector<std::vector<Eigen::Vector2d>> rings;
      for_each_ring(face.polygon, [&](const Ring3& ring) {
        std::vector<Eigen::Vector2d>& flat = rings.emplace_back();
        for (const Eigen::Vector3d& p : ring) flat.push_back(p.head<2>());
        const bool clockwise_from_above = face.normal.z() < 0;
        if (clockwise_from_above) std::reverse(flat.begin(), flat.end());
      });
      outlines.push_back(std::move(rings));
    }
    return outlines;
  };
  auto outlines = outlines_of(SurfaceClass::ground_surface);
  return outlines.empty() ? outlines_of(SurfaceClass::roof) : outlines;
}

}  // namespace priormap
