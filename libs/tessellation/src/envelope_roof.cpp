#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <priormap/tessellation/clip.hpp>

#include "roof_kinds.hpp"

namespace priormap {
namespace {

/// The outline seen along the slope: coordinate 0 to `width` across the ridge, 0 to `length` along it.
struct SlopeFrame {
  LinearFunction across, along;
  double width = 0, length = 0;
};

SlopeFrame slope_frame(const Ring2& ring, const Eigen::Vector2d& slope) {
  const Eigen::Vector2d ridge(-slope.y(), slope.x());
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector2d& p : ring) {
    const Eigen::Vector2d local(slope.dot(p), ridge.dot(p));
    low = low.cwiseMin(local);
    high = high.cwiseMax(local);
  }
  return {{slope, -low.x()}, {ridge, -low.y()}, high.x() - low.x(), high.y() - low.y()};
}

Eigen::Vector2d longest_edge_normal(const Ring2& ring) {
  Eigen::Vector2d longest = Eigen::Vector2d::UnitX();
  double length = 0;
  for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    if ((b - a).norm() <= length * (1 + 1e-9)) return;
    length = (b - a).norm();
    longest = (b - a) / length;
  });
  return {longest.y(), -longest.x()};  // outward: exteriors run counter-clockwise
}

/// Down the slope.
Eigen::Vector2d slope_direction(const Polygon2& outline, const RoofSpec& spec) {
  if (spec.direction_deg) {
    const double angle = *spec.direction_deg * std::numbers::pi / 180;
    return {std::sin(angle), std::cos(angle)};
  }
  if (spec.shape == RoofShape::skillion) return longest_edge_normal(outline.exterior);
  const OrientedBox box = oriented_box(outline.exterior);
  return spec.ridge_across ? box.along : box.across;
}

LinearFunction operator*(double factor, const LinearFunction& f) { return {factor * f.gradient, factor * f.offset}; }
LinearFunction operator+(const LinearFunction& f, double shift) { return {f.gradient, f.offset + shift}; }

/// The rising half of a concave profile from (0, 0) to (1, 1): share of the half width, share of the rise.
using Profile = std::vector<std::array<double, 2>>;

Profile profile_of(RoofShape shape) {
  if (shape == RoofShape::gambrel) return {{0, 0}, {1.0 / 3, 2.0 / 3}, {1, 1}};
  if (shape == RoofShape::round) {
    Profile arc;
    constexpr int facets = 6;
    for (int i = 0; i <= facets; ++i) {
      const double angle = 0.5 * std::numbers::pi * i / facets;
      arc.push_back({1 - std::cos(angle), std::sin(angle)});
    }
    return arc;
  }
  return {{0, 0}, {1, 1}};
}

/// Heights above the eaves; the roof is the lowest of them.
std::vector<LinearFunction> planes_of(const Polygon2& outline, const RoofSpec& spec) {
  const SlopeFrame frame = slope_frame(outline.exterior, slope_direction(outline, spec));
  if (!(frame.width > 0 && frame.length > 0)) return {};
  if (spec.shape == RoofShape::skillion) return {(-spec.rise_m / frame.width) * frame.across + spec.rise_m};

  std::vector<LinearFunction> planes;
  const double half = 0.5 * frame.width;
  const Profile profile = profile_of(spec.shape);
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const auto [d0, h0] = profile[i];
    const auto [d1, h1] = profile[i + 1];
    const double slope = (h1 - h0) / (d1 - d0) * spec.rise_m / half, start = h0 * spec.rise_m - slope * d0 * half;
    planes.push_back(slope * frame.across + start);
    planes.push_back((-slope) * frame.across + (start + slope * frame.width));
  }
  if (spec.shape == RoofShape::half_hipped) {  // the hips start halfway up the gables
    const double slope = std::max(spec.rise_m / half, spec.rise_m / frame.length);
    planes.push_back(slope * frame.along + 0.5 * spec.rise_m);
    planes.push_back((-slope) * frame.along + (0.5 * spec.rise_m + slope * frame.length));
  }
  return planes;
}

double height(const std::vector<LinearFunction>& planes, const Eigen::Vector2d& p) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const LinearFunction& plane : planes) lowest = std::min(lowest, plane(p));
  return lowest;
}

Ring3 lifted(const Ring2& ring, const LinearFunction& plane, double eaves_z) {
  Ring3 result;
  for (const Eigen::Vector2d& p : ring) result.emplace_back(p.x(), p.y(), eaves_z + plane(p));
  return result;
}

/// Along an edge the roof bends where two planes meet while being the lowest.
Ring3 wall_top(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const std::vector<LinearFunction>& planes, double eaves_z) {
  std::vector<double> bends{0, 1};
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const LinearFunction difference = planes[i] - planes[j];
      const double at_a = difference(a), at_b = difference(b);
      if (!((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0))) continue;
      const double t = at_a / (at_a - at_b);
      const Eigen::Vector2d p = a + t * (b - a);
      if (t > 1e-6 && t < 1 - 1e-6 && planes[i](p) <= height(planes, p) + 1e-9) bends.push_back(t);
    }
  std::ranges::sort(bends);
  Ring3 top;
  for (const double t : bends) {
    const Eigen::Vector2d p = a + t * (b - a);
    top.emplace_back(p.x(), p.y(), eaves_z + height(planes, p));
  }
  return top;
}

}  // namespace

double envelope_run_m(const Polygon2& outline, const RoofSpec& spec) {
  const double width = slope_frame(outline.exterior, slope_direction(outline, spec)).width;
  return spec.shape == RoofShape::skillion ? width : 0.5 * width;
}

std::optional<Roof> envelope_roof(const Polygon2& outline, double eaves_z, const RoofSpec& spec) {
  const Eigen::Vector2d anchor = outline.exterior.front();
  Polygon2 local = outline;  // small numbers keep the planes' digits
  for_each_ring(local, [&](Ring2& ring) { for (Eigen::Vector2d& p : ring) p -= anchor; });

  const std::vector<LinearFunction> planes = planes_of(local, spec);
  if (planes.empty()) return std::nullopt;
  Roof roof;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    std::vector<Polygon2> pieces{local};
    for (std::size_t j = 0; j < planes.size(); ++j)
      if (j != i) pieces = clip(pieces, planes[i] - planes[j]);
    for (const Polygon2& piece : pieces) {
      Polygon3 face{lifted(piece.exterior, planes[i], eaves_z), {}};
      for (const Ring2& hole : piece.holes) face.holes.push_back(lifted(hole, planes[i], eaves_z));
      roof.faces.push_back(std::move(face));
    }
  }
  for_each_ring(local, [&](const Ring2& ring) {
    for_each_edge(ring, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { roof.wall_tops.push_back(wall_top(a, b, planes, eaves_z)); });
  });
  const Eigen::Vector3d shift(anchor.x(), anchor.y(), 0);
  for (Polygon3& face : roof.faces) for_each_ring(face, [&](Ring3& ring) { for (Eigen::Vector3d& p : ring) p += shift; });
  for (Ring3& top : roof.wall_tops) for (Eigen::Vector3d& p : top) p += shift;
  return roof;
}

}  // namespace priormap
