#include <priormap/builder/solid_index.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "joints.hpp"

namespace priormap {
namespace {

constexpr double inset_m = 0.01;       // points on a face's edge are judged by the face beside them, not by what lies beyond it
constexpr double tolerance_m = 0.002;  // the seam of a shared wall belongs to the lower building

struct Extent {
  Bounds2 plan;
  double low_z, high_z;
};

Extent extent_of(const Ring3& ring) {
  Extent extent{{ring[0].x(), ring[0].y(), ring[0].x(), ring[0].y()}, ring[0].z(), ring[0].z()};
  for (const Eigen::Vector3d& p : ring) {
    extent.plan = {std::min(extent.plan.min_x, p.x()), std::min(extent.plan.min_y, p.y()), std::max(extent.plan.max_x, p.x()), std::max(extent.plan.max_y, p.y())};
    extent.low_z = std::min(extent.low_z, p.z());
    extent.high_z = std::max(extent.high_z, p.z());
  }
  return extent;
}

bool side_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x()) > 0;
}

/// A segment that neither crosses a ring nor starts inside the polygon stays outside of it.
bool comes_inside(const Polygon2& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  if (contains(polygon, a) || contains(polygon, b)) return true;
  bool crosses = false;
  for_each_ring(polygon, [&](const Ring2& ring) {
    for_each_edge(ring, [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
      crosses |= side_of(a, b, p) != side_of(a, b, q) && side_of(p, q, a) != side_of(p, q, b);
    });
  });
  return crosses;
}

/// Whether the way from `a` into a polygon leads through a wall of it that is parallel to the one that looks along the way.
bool enters_head_on(const Polygon2& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& inside) {
  const Eigen::Vector2d way = (inside - a).normalized();
  bool head_on = false;
  for_each_ring(polygon, [&](const Ring2& ring) {
    for_each_edge(ring, [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
      if (side_of(a, inside, p) == side_of(a, inside, q) || side_of(p, q, a) == side_of(p, q, inside)) return;
      head_on |= std::abs((q - p).normalized().dot(way)) < joint_sine;
    });
  });
  return head_on;
}

Eigen::Vector3d middle_of(const Ring3& ring) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : ring) sum += p - ring.front();
  return ring.front() + sum / static_cast<double>(ring.size());
}

}  // namespace

SolidIndex::SolidIndex(std::span<const BuildingSolid> solids) : solids_(solids) {
  for (std::uint32_t i = 0; i < solids_.size(); ++i)
    if (solids_[i].has_walls) index_.add(solids_[i].bounds, i);
  index_.sort();
}

std::vector<std::uint32_t> SolidIndex::near(std::uint32_t solid) const {
  std::vector<std::uint32_t> found = index_.meeting(grown(solids_[solid].bounds, joint_m));
  std::erase(found, solid);
  return found;
}

void SolidIndex::remove_hidden(const Face& face, const Eigen::Vector3d& normal, std::span<const std::uint32_t> candidates,
                               std::vector<Eigen::Vector3d>& points) const {
  const Ring3& exterior = face.polygon.exterior;
  const Extent extent = extent_of(exterior);
  const Eigen::Vector3d middle = middle_of(exterior), outward = touching_m * normal, across = joint_m * normal;
  const bool is_wall = face.surface_class == SurfaceClass::wall;   // begins with the edge on the ground
  std::vector<const BuildingSolid*> touching, facing;
  for (const std::uint32_t i : candidates) {
    const BuildingSolid& solid = solids_[i];
    if (extent.low_z > solid.top_z + tolerance_m || !meet(grown(extent.plan, joint_m), solid.bounds)) continue;
    const auto reaches = [&](const Eigen::Vector3d& step) { return comes_inside(solid.outline, (exterior[0] + step).head<2>(), (exterior[1] + step).head<2>()); };
    if (is_wall ? reaches(outward) : meet(grown(extent.plan, touching_m), solid.bounds)) touching.push_back(&solid);
    if (is_wall && reaches(across)) facing.push_back(&solid);
  }
  if (touching.empty() && facing.empty()) return;
  std::erase_if(points, [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d to_middle = middle - p;
    const double distance = to_middle.norm();
    const Eigen::Vector3d inset = distance > inset_m ? Eigen::Vector3d(to_middle * (inset_m / distance)) : Eigen::Vector3d::Zero();
    const auto holds = [&](const BuildingSolid& solid, const Eigen::Vector3d& step) {
      const Eigen::Vector3d probe = p + step + inset;
      return solid.holds({probe.x(), probe.y(), p.z() + step.z()}, tolerance_m);
    };
    return std::ranges::any_of(touching, [&](const BuildingSolid* solid) { return holds(*solid, outward); }) ||
           std::ranges::any_of(facing, [&](const BuildingSolid* solid) {
             return holds(*solid, across) && enters_head_on(solid->outline, (p + inset).head<2>(), (p + inset + across).head<2>());
           });
  });
}

}  // namespace priormap
