#include <priormap/tessellation/sample.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "plane_frame.hpp"

namespace priormap {
namespace {

using Edge2 = std::pair<Eigen::Vector2d, Eigen::Vector2d>;
using Edge3 = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

/// Number of equal steps of at most `step` that cover `length`; a hair's breadth over is not worth another step.
int steps(double length, double step) { return std::max(1, static_cast<int>(std::ceil(length / step - 1e-6))); }

struct Crossing {
  int row;
  double u;
  bool operator<(const Crossing& other) const { return row != other.row ? row < other.row : u < other.u; }
};

/// Points of a grid's row that lie inside of a face: columns [first, last].
struct Span {
  Eigen::Vector3d start;   ///< of the row
  int first, last;
};

/// Row by row, or column by column.
void append(const std::vector<Span>& spans, const Eigen::Vector3d& u, double du, bool by_columns, std::vector<Eigen::Vector3d>& points) {
  const auto push = [&](const Span& span, int column) { points.push_back(span.start + u * (column * du)); };
  if (!by_columns) {
    for (const Span& span : spans)
      for (int column = span.first; column <= span.last; ++column) push(span, column);
    return;
  }
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  for (const Span& span : spans) first = std::min(first, span.first), last = std::max(last, span.last);
  for (int column = first; column <= last; ++column)
    for (const Span& span : spans)
      if (column >= span.first && column <= span.last) push(span, column);
}

}  // namespace

struct FaceSampler::Scratch {
  std::vector<Edge3> edges;
  std::vector<Edge2> flat_edges;
  std::vector<Crossing> crossings;
  std::vector<Span> spans;

  void sample_edges(double spacing_m, std::vector<Eigen::Vector3d>& points) const;
  void sample_inside(const PlaneFrame& frame, double spacing_m, std::vector<Eigen::Vector3d>& points);
  void sample(const PlaneFrame& frame, double spacing_m, std::vector<Eigen::Vector3d>& points) {
    sample_edges(spacing_m, points);
    sample_inside(frame, spacing_m, points);
  }
};

/// From each edge its start and what lies between: the next edge brings the end.
void FaceSampler::Scratch::sample_edges(double spacing_m, std::vector<Eigen::Vector3d>& points) const {
  for (const auto& [a, b] : edges) {
    const Eigen::Vector3d along = b - a;
    const double length = along.norm();
    if (!(length > 0)) continue;
    const int n = steps(length, spacing_m);
    for (int i = 0; i < n; ++i) points.push_back(a + along * (static_cast<double>(i) / n));
  }
}

void FaceSampler::Scratch::sample_inside(const PlaneFrame& frame, double spacing_m, std::vector<Eigen::Vector3d>& points) {
  flat_edges.clear();
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& [a, b] : edges) {
    flat_edges.emplace_back(frame.to_plane(a), frame.to_plane(b));
    low = low.cwiseMin(flat_edges.back().first).cwiseMin(flat_edges.back().second);
    high = high.cwiseMax(flat_edges.back().first).cwiseMax(flat_edges.back().second);
  }
  const int num_columns = steps(high.x() - low.x(), spacing_m), num_rows = steps(high.y() - low.y(), spacing_m);
  const double du = (high.x() - low.x()) / num_columns, dv = (high.y() - low.y()) / num_rows;
  if (num_columns < 2 || num_rows < 2) return;  // the points along the edges suffice

  const auto row_after = [&](double v) { return static_cast<int>(std::ceil((v - low.y()) / dv)); };
  crossings.clear();
  for (const auto& [a, b] : flat_edges) {
    const auto& [lower, upper] = a.y() < b.y() ? std::pair(a, b) : std::pair(b, a);
    const int last = std::min(row_after(upper.y()), num_rows);
    const double slope = (upper.x() - lower.x()) / (upper.y() - lower.y());
    for (int row = std::max(1, row_after(lower.y())); row < last; ++row)
      crossings.push_back({row, lower.x() + (low.y() + row * dv - lower.y()) * slope});
  }
  std::ranges::sort(crossings, std::less<>());

  spans.clear();
  const double margin = 0.25 * spacing_m;  // points along the edges already cover what is nearer
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    const auto& [row, begin_u] = crossings[i];
    const double end_u = crossings[i + 1].u;
    const int first = static_cast<int>(std::ceil((begin_u + margin - low.x()) / du));
    const int last = static_cast<int>(std::floor((end_u - margin - low.x()) / du));
    const Eigen::Vector3d start = frame.origin + frame.u * low.x() + frame.v * (low.y() + row * dv);
    spans.push_back({start, first, last});
  }
  // What stands above each other comes in a row, for those who sort.
  constexpr double upright = 1e-9;
  append(spans, frame.u, du, std::hypot(frame.v.x(), frame.v.y()) < upright, points);
}

FaceSampler::FaceSampler(double spacing_m) : spacing_m_(spacing_m), scratch_(std::make_unique<Scratch>()) {}
FaceSampler::~FaceSampler() = default;

Eigen::Vector3d FaceSampler::sample(const Polygon3& face, std::vector<Eigen::Vector3d>& points) {
  const std::optional<PlaneFrame> frame = PlaneFrame::of(face);
  if (!frame) return Eigen::Vector3d::Zero();
  scratch_->edges.clear();
  for_each_ring(face, [&](const Ring3& ring) {
    for_each_edge(ring, [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { scratch_->edges.emplace_back(a, b); });
  });
  scratch_->sample(*frame, spacing_m_, points);
  return frame->n;
}

namespace {

/// Triangles that share an edge, by triangle; 3 a triangle, -1 where the edge is open or shared by more than two.
std::vector<std::array<int, 3>> triangle_neighbors(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<int, int>>> sides_of;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto a = mesh.triangles[t][static_cast<std::size_t>(i)], b = mesh.triangles[t][static_cast<std::size_t>((i + 1) % 3)];
      sides_of[std::minmax(a, b)].emplace_back(static_cast<int>(t), i);
    }
  std::vector<std::array<int, 3>> neighbors(mesh.triangles.size(), {-1, -1, -1});
  for (const auto& [edge, sides] : sides_of) {
    if (sides.size() != 2) continue;
    neighbors[static_cast<std::size_t>(sides[0].first)][static_cast<std::size_t>(sides[0].second)] = sides[1].first;
    neighbors[static_cast<std::size_t>(sides[1].first)][static_cast<std::size_t>(sides[1].second)] = sides[0].first;
  }
  return neighbors;
}

struct TrianglePlane {
  Eigen::Vector3d point, normal;  ///< normal is zero for a triangle without area
  bool holds(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle, const Eigen::Vector3d& its_normal) const {
    constexpr double tolerance_m = 1e-3, parallel = 0.999;
    if (its_normal.dot(normal) < parallel) return false;
    return std::ranges::all_of(triangle, [&](std::uint32_t i) { return std::abs(normal.dot(mesh.vertices[i] - point)) <= tolerance_m; });
  }
};

}  // namespace

void FaceSampler::sample(const TriangleMesh& mesh, std::vector<Eigen::Vector3d>& points, std::vector<Eigen::Vector3d>& normals) {
  const auto neighbors = triangle_neighbors(mesh);
  std::vector<Eigen::Vector3d> triangle_normals;
  for (const auto& [a, b, c] : mesh.triangles)
    triangle_normals.push_back((mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).normalized());

  std::vector<int> patch_of(mesh.triangles.size(), -1);
  std::vector<std::size_t> patch;
  for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (patch_of[seed] != -1 || triangle_normals[seed].isZero()) continue;
    const TrianglePlane plane{mesh.vertices[mesh.triangles[seed][0]], triangle_normals[seed]};
    const int id = static_cast<int>(seed);
    patch.assign(1, seed);
    patch_of[seed] = id;
    for (std::size_t next = 0; next < patch.size(); ++next)
      for (const int neighbor : neighbors[patch[next]]) {
        const auto n = static_cast<std::size_t>(neighbor);
        if (neighbor < 0 || patch_of[n] != -1 || !plane.holds(mesh, mesh.triangles[n], triangle_normals[n])) continue;
        patch_of[n] = id;
        patch.push_back(n);
      }

    scratch_->edges.clear();
    Eigen::Vector3d longest = Eigen::Vector3d::Zero();
    for (const std::size_t t : patch)
      for (std::size_t i = 0; i < 3; ++i) {
        const int neighbor = neighbors[t][i];
        if (neighbor >= 0 && patch_of[static_cast<std::size_t>(neighbor)] == id) continue;
        const Eigen::Vector3d &a = mesh.vertices[mesh.triangles[t][i]], &b = mesh.vertices[mesh.triangles[t][(i + 1) % 3]];
        if ((b - a).squaredNorm() > longest.squaredNorm()) longest = b - a;
        scratch_->edges.emplace_back(a, b);
      }
    if (const auto frame = PlaneFrame::from(plane.point, longest, plane.normal)) scratch_->sample(*frame, spacing_m_, points);
    normals.resize(points.size(), plane.normal);
  }
}

PointCloud sample(const TriangleMesh& mesh, double spacing_m, const Eigen::Vector3d& origin) {
  std::vector<Eigen::Vector3d> points, normals;
  FaceSampler(spacing_m).sample(mesh, points, normals);
  PointCloud cloud;
  cloud.origin = origin;
  cloud.reserve(points.size());
  for (const Eigen::Vector3d& p : points) cloud.xyz.push_back((p - origin).cast<float>());
  cloud.normal.reserve(points.size());
  for (const Eigen::Vector3d& n : normals) cloud.normal.push_back(n.cast<float>());
  return cloud;
}

}  // namespace priormap
