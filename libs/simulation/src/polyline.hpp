#pragma once
#include <Eigen/Core>
#include <vector>

namespace priormap {

using Polyline = std::vector<Eigen::Vector2d>;

double length(const Polyline& line);
/// Points every `step_m` along the line, its first one included.
Polyline resampled(const Polyline& line, double step_m);

/// The part of a line `length_m` long around its middle, a point every metre; empty when the length is 0.
Polyline middle_of(const Polyline& line, double length_m);

/// A line by its length: where one is after s metres, and which way it goes there.
class Run {
 public:
  explicit Run(const Polyline& line);
  double length() const { return stations_.back(); }
  Eigen::Vector2d point(double s) const;
  Eigen::Vector2d direction(double s) const;   ///< unit

 private:
  std::size_t segment(double s) const;
  Polyline line_;
  std::vector<double> stations_;
};

}  // namespace priormap
