#include <priormap/builder/line_of_sight.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <tuple>

#include <priormap/raycast/ray_scene.hpp>

namespace priormap {
namespace {

constexpr double cell_m = 1;
constexpr double lift_m = 0.1;   // rays start in front of the face, clear of a wall that touches it
constexpr double rise_m = 2;     // of a roof over its eaves

using Cell = std::array<std::int32_t, 3>;

Cell cell_of(const Eigen::Vector3d& p) {
  const Eigen::Vector3d cell = (p / cell_m).array().floor();
  return {static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y()), static_cast<std::int32_t>(cell.z())};
}

bool has_neighbor(const Cell& cell, const std::vector<Cell>& sorted) {
  for (std::int32_t dx = -1; dx <= 1; ++dx)
    for (std::int32_t dy = -1; dy <= 1; ++dy) {   // cells along z follow each other
      const auto at = std::ranges::lower_bound(sorted, Cell{cell[0] + dx, cell[1] + dy, cell[2] - 1});
      if (at != sorted.end() && *at <= Cell{cell[0] + dx, cell[1] + dy, cell[2] + 1}) return true;
    }
  return false;
}

Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = low;
  if (!points.empty()) low = high = points.front();
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (0.5 * (low + high)).array().round();
}

}  // namespace

void FacePoints::clear() {
  points.clear();
  normals.clear();
  faces.clear();
}

struct LineOfSight::Scene {
  RayScene rays;
};

/// What one face has in one cell, judged by the first of its points there.
struct LineOfSight::Patch {
  Cell cell;
  std::uint32_t face;
  std::uint32_t point;
  bool is_seen = false;
};

LineOfSight::LineOfSight(std::vector<Eigen::Vector3d> viewpoints, const TriangleMesh& occluders, double range_m)
    : viewpoints_(std::move(viewpoints)), range_m_(range_m),
      scene_(std::make_unique<Scene>(RayScene(std::span(&occluders, 1), middle_of(occluders.vertices)))) {
  for (std::uint32_t i = 0; i < viewpoints_.size(); ++i) {
    const Eigen::Vector3d& p = viewpoints_[i];
    index_.add({p.x(), p.y(), p.x(), p.y()}, i);
  }
  index_.sort();
}

LineOfSight::~LineOfSight() = default;
LineOfSight::LineOfSight(LineOfSight&&) noexcept = default;

/// Nearest first: they decide most.
std::vector<std::uint32_t> LineOfSight::viewpoints_near(const std::vector<Eigen::Vector3d>& points) const {
  Eigen::Vector2d low = points.front().head<2>(), high = low;
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  const Eigen::Vector2d middle = 0.5 * (low + high);
  std::vector<std::uint32_t> near = index_.meeting(grown({low.x(), low.y(), high.x(), high.y()}, range_m_));
  std::ranges::stable_sort(near, {}, [&](std::uint32_t i) { return (viewpoints_[i].head<2>() - middle).squaredNorm(); });
  return near;
}

void LineOfSight::find_seen(const FacePoints& points, Skin skin, std::vector<Patch>& patches) const {
  std::vector<std::uint32_t> unseen(patches.size()), asked;
  std::iota(unseen.begin(), unseen.end(), 0u);
  std::vector<Segment> segments;
  std::vector<std::uint8_t> blocked;
  for (const std::uint32_t v : viewpoints_near(points.points)) {
    const Eigen::Vector3d& viewpoint = viewpoints_[v];
    const bool at_unknown_height = std::isnan(viewpoint.z());
    asked.clear();
    segments.clear();
    for (const std::uint32_t i : unseen) {
      const Eigen::Vector3d &point = points.points[patches[i].point], &normal = points.normals[patches[i].point];
      const Eigen::Vector3d way = viewpoint - point;
      if (at_unknown_height) {
        patches[i].is_seen = way.head<2>().norm() <= range_m_;
        continue;
      }
      const bool rises = skin == Skin::may_rise && normal.z() > 0.99;
      const double in_front = normal.dot(way);
      if (way.norm() > range_m_ || (skin != Skin::open && !rises && in_front <= 0)) continue;
      const Eigen::Vector3d from = point + (rises ? rise_m : std::copysign(lift_m, in_front)) * normal;
      asked.push_back(i);
      segments.push_back({(from - scene_->rays.origin()).cast<float>(), (viewpoint - scene_->rays.origin()).cast<float>()});
    }
    blocked.resize(segments.size());
    scene_->rays.cast(segments, blocked);
    for (std::size_t k = 0; k < asked.size(); ++k) patches[asked[k]].is_seen = blocked[k] == 0;
    std::erase_if(unseen, [&](std::uint32_t i) { return patches[i].is_seen; });
    if (unseen.empty()) return;
  }
}

std::vector<bool> LineOfSight::seen(const FacePoints& points, Skin skin) const {
  std::vector<bool> flags(points.points.size(), false);
  if (flags.empty()) return flags;
  std::vector<Patch> all;
  all.reserve(flags.size());
  for (std::uint32_t i = 0; i < flags.size(); ++i) all.push_back({cell_of(points.points[i]), points.faces[i], i});
  std::ranges::sort(all, {}, [](const Patch& patch) { return std::tie(patch.cell, patch.face, patch.point); });
  std::vector<Patch> patches;
  std::ranges::unique_copy(all, std::back_inserter(patches), {}, [](const Patch& patch) { return std::tie(patch.cell, patch.face); });
  find_seen(points, skin, patches);

  std::vector<Cell> seen_cells;
  for (const Patch& patch : patches)
    if (patch.is_seen && (seen_cells.empty() || seen_cells.back() != patch.cell)) seen_cells.push_back(patch.cell);
  bool near = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == 0 || all[i].cell != all[i - 1].cell) near = has_neighbor(all[i].cell, seen_cells);
    flags[all[i].point] = near;
  }
  return flags;
}

}  // namespace priormap
