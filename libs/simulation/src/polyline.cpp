#include "polyline.hpp"

#include <algorithm>

namespace priormap {

double length(const Polyline& line) { return Run(line).length(); }

Polyline resampled(const Polyline& line, double step_m) {
  const Run run(line);
  Polyline points;
  for (std::size_t i = 0; static_cast<double>(i) * step_m <= run.length(); ++i)
    points.push_back(run.point(static_cast<double>(i) * step_m));
  return points;
}

Polyline middle_of(const Polyline& line, double length_m) {
  Polyline stretch;
  if (length_m <= 0) return stretch;
  const Run run(line);
  const double start = std::max(0.0, 0.5 * (run.length() - length_m));
  for (double s = start; s <= std::min(run.length(), start + length_m); s += 1) stretch.push_back(run.point(s));
  return stretch;
}

Run::Run(const Polyline& line) : line_(line), stations_{0} {
  for (std::size_t i = 1; i < line_.size(); ++i) stations_.push_back(stations_.back() + (line_[i] - line_[i - 1]).norm());
}

std::size_t Run::segment(double s) const {
  const auto next = std::upper_bound(stations_.begin(), stations_.end(), s);
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - stations_.begin() - 1, 0));
  return std::min(i, line_.size() < 2 ? 0 : line_.size() - 2);
}

Eigen::Vector2d Run::point(double s) const {
  if (line_.size() < 2) return line_.front();
  const std::size_t i = segment(s);
  const double run = stations_[i + 1] - stations_[i];
  return line_[i] + (run > 0 ? (s - stations_[i]) / run : 0.0) * (line_[i + 1] - line_[i]);
}

Eigen::Vector2d Run::direction(double s) const {
  if (line_.size() < 2) return Eigen::Vector2d::UnitX();
  const std::size_t i = segment(s);
  const Eigen::Vector2d run = line_[i + 1] - line_[i];
  return run.norm() > 0 ? Eigen::Vector2d(run.normalized()) : Eigen::Vector2d(Eigen::Vector2d::UnitX());
}

}  // namespace priormap
