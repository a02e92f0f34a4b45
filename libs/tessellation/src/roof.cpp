#include <priormap/tessellation/roof.hpp>

#include <algorithm>

#include <priormap/tessellation/extrude.hpp>

#include "roof_kinds.hpp"

namespace priormap {
namespace {

enum class Construction { flat, envelope, radial, skeleton, none };

/// Houses with wings get a ridge a wing; nearly rectangular ones a single ridge.
bool fills_its_box(const Polygon2& outline) {
  const OrientedBox box = oriented_box(outline.exterior);
  return area(outline) > 0.9 * 4 * box.half_length * box.half_width;
}

bool seen_whole_from_center(const Polygon2& outline) { return radial_run_m(outline) > 0; }

Construction construction_of(const Polygon2& outline, const RoofSpec& spec) {
  switch (spec.shape) {
    case RoofShape::flat: return Construction::flat;
    case RoofShape::gabled: return spec.direction_deg || spec.ridge_across || fills_its_box(outline) ? Construction::envelope : Construction::skeleton;
    case RoofShape::skillion:
    case RoofShape::half_hipped:
    case RoofShape::gambrel:
    case RoofShape::round: return Construction::envelope;
    case RoofShape::pyramidal: return seen_whole_from_center(outline) ? Construction::radial : Construction::skeleton;
    case RoofShape::cone:
    case RoofShape::dome:
    case RoofShape::onion: return Construction::radial;
    case RoofShape::hipped:
    case RoofShape::mansard: return Construction::skeleton;
    case RoofShape::other: return Construction::none;
  }
  return Construction::none;
}

std::optional<Roof> construct(const Polygon2& outline, double eaves_z, const RoofSpec& spec) {
  switch (construction_of(outline, spec)) {
    case Construction::flat: return flat_roof(outline, eaves_z + spec.rise_m);
    case Construction::envelope: return envelope_roof(outline, eaves_z, spec);
    case Construction::radial: return radial_roof(outline, eaves_z, spec);
    case Construction::skeleton: {
      std::optional<Roof> roof = skeleton_roof(outline, eaves_z, spec);
      return roof || spec.shape != RoofShape::gabled ? roof : envelope_roof(outline, eaves_z, spec);
    }
    case Construction::none: break;
  }
  return std::nullopt;
}

/// Negative where a face overhangs.
double plan_area(const Polygon3& face) { return 0.5 * newell_normal(face).z(); }

/// The faces must cover the outline once: a failed skeleton or cut shows here.
bool covers(const Roof& roof, const Polygon2& outline) {
  double covered = 0;
  for (const Polygon3& face : roof.faces) covered += plan_area(face);
  return std::abs(covered - area(outline)) <= 1e-3 * area(outline);
}

}  // namespace

double roof_run_m(const Polygon2& outline, const RoofSpec& spec) {
  switch (construction_of(outline, spec)) {
    case Construction::envelope: return envelope_run_m(outline, spec);
    case Construction::radial: return radial_run_m(outline);
    case Construction::skeleton: return skeleton_run_m(outline);
    case Construction::flat:
    case Construction::none: break;
  }
  return 0;
}

std::optional<Roof> make_roof(const Polygon2& outline, double eaves_z, const RoofSpec& spec) {
  if (spec.rise_m <= 0 && spec.shape != RoofShape::other) return flat_roof(outline, eaves_z);
  std::optional<Roof> roof = construct(outline, eaves_z, spec);
  return roof && covers(*roof, outline) ? roof : std::nullopt;
}

std::vector<Ring3> level_wall_tops(const Polygon2& outline, double z) {
  std::vector<Ring3> tops;
  for_each_ring(outline, [&](const Ring2& ring) {
    for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { tops.push_back({{a.x(), a.y(), z}, {b.x(), b.y(), z}}); });
  });
  return tops;
}

Roof flat_roof(const Polygon2& outline, double z) {
  return {{level_face(outline, z, SurfaceClass::roof, true).polygon}, level_wall_tops(outline, z)};
}

std::vector<Face> roofed_faces(const Polygon2& outline, double base_z, const Roof& roof, bool with_walls, bool with_underside) {
  std::vector<Face> faces;
  if (with_walls)
    for (const Ring3& top : roof.wall_tops) {
      const Eigen::Vector3d &a = top.front(), &b = top.back();
      Face wall{{{{a.x(), a.y(), base_z}, {b.x(), b.y(), base_z}}, {}}, SurfaceClass::wall};
      wall.polygon.exterior.insert(wall.polygon.exterior.end(), top.rbegin(), top.rend());
      faces.push_back(std::move(wall));
    }
  for (const Polygon3& face : roof.faces) faces.push_back({face, SurfaceClass::roof});
  if (!with_underside) return faces;
  if (with_walls) {
    faces.push_back(level_face(outline, base_z, SurfaceClass::outer_floor, false));
  } else {
    for (const Polygon3& face : roof.faces) {
      Face underside{face, SurfaceClass::outer_ceiling};
      for_each_ring(underside.polygon, [](Ring3& ring) { std::ranges::reverse(ring); });
      faces.push_back(std::move(underside));
    }
  }
  return faces;
}

}  // namespace priormap
