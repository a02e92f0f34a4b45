#include "point_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <priormap/core/also_avx2.hpp>
#include <priormap/geodesy/lattice.hpp>

namespace priormap {
namespace {

/// Beyond this difference of slope between its two sides a cell lies on a step, such as a roof's edge.
constexpr double step_slope = 1;

/// The step of height from a place to the next, given the heights before and after: the mean of both sides, or the flatter side where they
/// differ by more than `limit`, or the one that is known. NaN where neither is. Without branches, for a line at once.
inline float height_step(double before, double z, double after, float limit) {
  const auto in = static_cast<float>(z - before), out = static_cast<float>(after - z);
  const float flatter = std::abs(in) <= std::abs(out) ? in : out;
  const float known = in == in ? (out == out ? flatter : in) : out;
  return std::abs(in - out) <= limit ? 0.5f * (in + out) : known;
}

/// The inner places of a line as points have them; z is `none` where there is no point.
struct LineSteps {
  static constexpr std::int32_t none = std::numeric_limits<std::int32_t>::min();

  explicit LineSteps(std::size_t count) : x(count), y(count), z(count), normal_x(count), normal_y(count), normal_z(count) {}
  std::vector<std::int32_t> x, y, z;
  std::vector<std::int16_t> normal_x, normal_y, normal_z;
};

class NormalRule {
 public:
  explicit NormalRule(const PointGrid& grid)
      : line_length_(grid.length),
        across_(grid.across.cast<float>()),
        back_(grid.back.cast<float>()),
        up_(across_.x() * back_.y() - across_.y() * back_.x()),
        limit_across_(static_cast<float>(step_slope) * across_.norm()),
        limit_back_(static_cast<float>(step_slope) * back_.norm()),
        sign_(up_ < 0 ? -1.0f : 1.0f) {}

  /// (across, step) x (back, step), upwards, of the places from `z` on; zero where a step is not known.
  PRIORMAP_ALSO_AVX2 void of_line(const double* z, LineSteps& line) const {
    const double *before = z - line_length_, *after = z + line_length_;
    const float across_x = across_.x(), across_y = across_.y(), back_x = back_.x(), back_y = back_.y();
    const float up = up_, limit_across = limit_across_, limit_back = limit_back_, sign = sign_;
    std::int16_t *nx = line.normal_x.data(), *ny = line.normal_y.data(), *nz = line.normal_z.data();
    const std::size_t count = line.z.size();
    for (std::size_t i = 0; i < count; ++i) {
      const float a = height_step(before[i], z[i], after[i], limit_across), b = height_step(z[i + 1], z[i], z[i - 1], limit_back);
      const float x = across_y * b - a * back_y, y = a * back_x - across_x * b;
      const float scale = sign / std::sqrt(x * x + y * y + up * up);
      const bool known = scale == scale;
      nx[i] = LasPoint::normal_steps(known ? x * scale : 0);
      ny[i] = LasPoint::normal_steps(known ? y * scale : 0);
      nz[i] = LasPoint::normal_steps(known ? up * scale : 0);
    }
  }

 private:
  std::size_t line_length_;
  Eigen::Vector2f across_, back_;
  float up_, limit_across_, limit_back_, sign_;
};

/// An area in whole thousandths.
class LatticeArea {
 public:
  explicit LatticeArea(const Bounds2& area)
      : min_x_(lattice_steps(area.min_x)), min_y_(lattice_steps(area.min_y)), max_x_(lattice_steps(area.max_x)), max_y_(lattice_steps(area.max_y)) {}

  bool contains(double x, double y) const { return (x >= min_x_) & (x < max_x_) & (y >= min_y_) & (y < max_y_); }
  std::int32_t x_steps(double x) const { return static_cast<std::int32_t>(x - min_x_); }
  std::int32_t y_steps(double y) const { return static_cast<std::int32_t>(y - min_y_); }

  PRIORMAP_ALSO_AVX2 void positions_of_line(const double* x, const double* y, const double* z, LineSteps& line) const {
    const LatticeArea area = *this;
    std::int32_t *to_x = line.x.data(), *to_y = line.y.data(), *to_z = line.z.data();
    const std::size_t count = line.z.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double at_x = lattice_steps(x[i]), at_y = lattice_steps(y[i]), at_z = lattice_steps(z[i]);
      const bool inside = area.contains(at_x, at_y) & (at_z == at_z);
      to_x[i] = static_cast<std::int32_t>(inside ? at_x - area.min_x_ : 0);
      to_y[i] = static_cast<std::int32_t>(inside ? at_y - area.min_y_ : 0);
      to_z[i] = static_cast<std::int32_t>(inside ? at_z : LineSteps::none);
    }
  }

 private:
  double min_x_, min_y_, max_x_, max_y_;
};

/// Adds the points of the walls that a grid has.
class WallBuilder {
 public:
  WallBuilder(const PointGrid& grid, const StepWalls& walls, const LatticeArea& area, const LasPoint& common, std::vector<LasPoint>& points)
      : grid_(grid), walls_(walls), area_(area), common_(common), points_(points), length_(static_cast<std::ptrdiff_t>(grid.length)), gradient_(gradient_of(grid)) {}

  bool is_to_next_line(std::size_t place) const { return is_between(place, place + grid_.length); }
  bool is_to_place_before(std::size_t place) const { return is_between(place, place - 1); }
  void add_to_next_line(std::size_t place) { add(place, length_, {1, 0}); }
  void add_to_place_before(std::size_t place) { add(place, -1, {0, 1}); }

 private:
  bool is_between(std::size_t a, std::size_t b) const {
    const double step = std::abs(grid_.z[b] - grid_.z[a]);
    return step > walls_.least_step && step <= walls_.greatest_step;
  }

  /// From steps along (across, back) to those along (x, y), times a constant.
  static Eigen::Matrix2f gradient_of(const PointGrid& grid) {
    Eigen::Matrix2d steps;
    steps << grid.across, grid.back;
    return (std::abs(steps.determinant()) * steps.inverse().transpose()).cast<float>();
  }

  /// Towards what is low around a wall, in (across, back) of the grid: what the 16 places within two cells say that are higher or lower than the middle of the wall. Where they
  /// show no edge that faces as the wall does (a corner, a tree), its own two places say it.
  Eigen::Vector2f outward(std::size_t a, std::ptrdiff_t to_b, const Eigen::Vector2f& way) const {
    constexpr float least_facing = 0.15f;   // a wall at any angle to the grid is a stair of steps in both of its directions
    const std::size_t b = a + static_cast<std::size_t>(to_b);
    const float downhill = grid_.z[b] < grid_.z[a] ? 1.0f : -1.0f;
    const double middle = 0.5 * (grid_.z[a] + grid_.z[b]);
    const std::ptrdiff_t aside = to_b == length_ ? -1 : length_;
    Eigen::Vector2f low = Eigen::Vector2f::Zero();   // along the wall's way, and aside
    for (std::ptrdiff_t i = -1; i <= 2; ++i) {
      const std::ptrdiff_t widest = i == 0 || i == 1 ? 2 : 1;
      for (std::ptrdiff_t j = -widest; j <= widest; ++j) {
        const double z = grid_.z[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(a) + i * to_b + j * aside)];
        const float sign = z < middle ? 1.0f : z > middle ? -1.0f : 0.0f;
        low += sign * Eigen::Vector2f(static_cast<float>(i) - 0.5f, static_cast<float>(j));
      }
    }
    if (downhill * low.x() <= least_facing * low.norm()) low = {downhill, 0};
    return low.x() * way + low.y() * Eigen::Vector2f(way.y(), way.x());
  }

  /// From the lowest point up. @param to_b  from place `a` to its neighbour   @param way  the same in (across, back)
  void add(std::size_t a, std::ptrdiff_t to_b, const Eigen::Vector2f& way) {
    const std::size_t b = a + static_cast<std::size_t>(to_b);
    const double step = grid_.z[b] - grid_.z[a];
    const double x = lattice_steps(0.5 * (grid_.x[a] + grid_.x[b])), y = lattice_steps(0.5 * (grid_.y[a] + grid_.y[b]));
    if (!area_.contains(x, y)) return;
    const Eigen::Vector2f normal = (gradient_ * outward(a, to_b, way)).normalized();
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(std::abs(step) / walls_.rise)));
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t part = step < 0 ? count - 1 - i : i;
      LasPoint& wall = points_.emplace_back(common_);   // written in place: copied as a whole it would wait for its own narrow stores
      wall.x = area_.x_steps(x);
      wall.y = area_.y_steps(y);
      wall.z = static_cast<std::int32_t>(lattice_steps(grid_.z[a] + step * (static_cast<double>(part) + 0.5) / static_cast<double>(count)));
      wall.set_normal({normal.x(), normal.y(), 0});
    }
  }

  const PointGrid& grid_;
  const StepWalls& walls_;
  const LatticeArea& area_;
  const LasPoint& common_;
  std::vector<LasPoint>& points_;
  std::ptrdiff_t length_;
  Eigen::Matrix2f gradient_;
};

/// Adds the points of places [first, last) of a line.
void append(const LineSteps& line, std::size_t first, std::size_t last, const LasPoint& common, std::vector<LasPoint>& points) {
  const std::int32_t *x = line.x.data(), *y = line.y.data(), *z = line.z.data();
  const std::int16_t *normal_x = line.normal_x.data(), *normal_y = line.normal_y.data(), *normal_z = line.normal_z.data();
  for (std::size_t i = first; i < last; ++i) {
    if (z[i] == LineSteps::none) continue;
    LasPoint& point = points.emplace_back(common);
    point.x = x[i];
    point.y = y[i];
    point.z = z[i];
    point.normal[0] = normal_x[i];
    point.normal[1] = normal_y[i];
    point.normal[2] = normal_z[i];
  }
}

}  // namespace

void PointGrid::resize(std::size_t new_lines, std::size_t new_length) {
  lines = new_lines;
  length = new_length;
  x.resize(size());
  y.resize(size());
  z.resize(size());
}

void points_of_grid(const PointGrid& grid, const std::optional<StepWalls>& walls, const Bounds2& area, const LasPoint& common,
                    const std::function<void(std::vector<LasPoint>& points)>& visit) {
  constexpr std::size_t margin = PointGrid::margin;
  if (grid.lines <= 2 * margin || grid.length <= 2 * margin) return;
  constexpr std::size_t enough = 512;   // stay in the fastest cache
  std::vector<LasPoint> points;
  const LatticeArea lattice(area);
  const NormalRule normals(grid);
  std::optional<WallBuilder> builder;
  if (walls) builder.emplace(grid, *walls, lattice, common, points);
  LineSteps line(grid.length - 2 * margin);
  for (std::size_t i = margin * (grid.length + 1); i + margin * grid.length < grid.size(); i += grid.length) {
    lattice.positions_of_line(&grid.x[i], &grid.y[i], &grid.z[i], line);
    normals.of_line(&grid.z[i], line);
    const std::size_t count = line.z.size();
    std::size_t done = 0;
    for (std::size_t k = 0; builder && k < count; ++k) {
      if (!builder->is_to_place_before(i + k)) continue;
      append(line, std::exchange(done, k), k, common, points);
      builder->add_to_place_before(i + k);
    }
    append(line, done, count, common, points);
    for (std::size_t k = 0; builder && k < count; ++k)
      if (builder->is_to_next_line(i + k)) builder->add_to_next_line(i + k);
    if (points.size() < enough) continue;
    visit(points);
    points.clear();
  }
  if (!points.empty()) visit(points);
}

void walls_of_grid(const PointGrid& grid, const StepWalls& walls, const Bounds2& area, const LasPoint& common, const std::function<void(std::vector<LasPoint>& points)>& visit) {
  constexpr std::size_t margin = PointGrid::margin;
  if (grid.lines <= 2 * margin || grid.length <= 2 * margin) return;
  std::vector<LasPoint> points;
  const LatticeArea lattice(area);
  WallBuilder builder(grid, walls, lattice, common, points);
  for (std::size_t line = margin * grid.length; line + margin * grid.length < grid.size(); line += grid.length)
    for (std::size_t place = line + margin; place + margin < line + grid.length; ++place) {
      if (builder.is_to_place_before(place)) builder.add_to_place_before(place);
      if (builder.is_to_next_line(place)) builder.add_to_next_line(place);
    }
  if (!points.empty()) visit(points);
}

}  // namespace priormap
