#pragma once
#include <vector>

#include <priormap/tessellation/polygon.hpp>

namespace priormap {

/// Linear function of the plane: value(p) = offset + gradient . p.
struct LinearFunction {
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  double offset = 0;
  double operator()(const Eigen::Vector2d& p) const { return offset + gradient.dot(p); }
  LinearFunction operator-(const LinearFunction& other) const { return {gradient - other.gradient, offset - other.offset}; }
};

/// The part of a normalized polygon where `side` <= 0; several polygons where the line cuts it apart.
std::vector<Polygon2> clip(const Polygon2& polygon, const LinearFunction& side);
std::vector<Polygon2> clip(const std::vector<Polygon2>& polygons, const LinearFunction& side);

}  // namespace priormap
