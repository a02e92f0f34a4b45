#include "point_grid.hpp"

namespace priormap {
namespace {

/// Beyond this difference of slope between its two sides a cell lies on a step, such as a roof's edge.
constexpr double step_slope = 1;

/// In whole thousandths: adding and taking away 1.5 * 2^52 rounds to the nearest, without a library call.
inline double thousandths(double v) {
  constexpr double rounding = 6755399441055744.0;
  return (v * 1000 + rounding) - rounding;
}

/// The step of height from a point to the next, given the heights before and after: the mean of both sides, or the flatter side where they
/// differ by more than `limit`, or the one that is known. NaN where neither is.
inline float height_step(double before, double z, double after, float limit) {
  const auto in = static_cast<float>(z - before), out = static_cast<float>(after - z);
  const bool in_known = in == in, out_known = out == out;
  const float flatter = in_known && (!out_known || std::abs(in) <= std::abs(out)) ? in : out;
  return std::abs(in - out) <= limit ? 0.5f * (in + out) : flatter;
}

class NormalRule {
 public:
  explicit NormalRule(const PointGrid& grid)
      : along_(grid.along.cast<float>()),
        down_(grid.down.cast<float>()),
        up_(along_.x() * down_.y() - along_.y() * down_.x()),
        limit_along_(static_cast<float>(step_slope) * along_.norm()),
        limit_down_(static_cast<float>(step_slope) * down_.norm()),
        sign_(up_ < 0 ? -1.0f : 1.0f) {}

  /// (along, step) x (down, step), upwards; zero where a step is not known.
  Eigen::Vector3f at(const double* z, std::size_t width) const {
    const float a = height_step(z[-1], z[0], z[1], limit_along_);
    const float d = height_step(z[-static_cast<std::ptrdiff_t>(width)], z[0], z[width], limit_down_);
    const float x = along_.y() * d - a * down_.y(), y = a * down_.x() - along_.x() * d;
    const float scale = sign_ / std::sqrt(x * x + y * y + up_ * up_);
    return scale == scale ? Eigen::Vector3f(x * scale, y * scale, up_ * scale) : Eigen::Vector3f(0, 0, 0);
  }

 private:
  Eigen::Vector2f along_, down_;
  float up_, limit_along_, limit_down_, sign_;
};

}  // namespace

void PointGrid::resize(std::size_t new_width, std::size_t new_height) {
  width = new_width;
  height = new_height;
  x.resize(size());
  y.resize(size());
  z.resize(size());
}

void points_of_grid(const PointGrid& grid, const Bounds2& area, PointCloud& points) {
  points.clear();
  if (grid.width < 3 || grid.height < 3) return;
  const std::size_t inner_width = grid.width - 2, inner_height = grid.height - 2;
  const NormalRule rule(grid);
  const Bounds2 inside{thousandths(area.min_x), thousandths(area.min_y), thousandths(area.max_x), thousandths(area.max_y)};
  points.xyz.resize(inner_width * inner_height);
  points.normal.resize(inner_width * inner_height);
  Eigen::Vector3d origin;
  std::size_t count = 0;
  for (std::size_t col = 1; col <= inner_width; ++col) {
    for (std::size_t row = inner_height; row > 0; --row) {
      const std::size_t i = row * grid.width + col;
      const Eigen::Vector3d p(thousandths(grid.x[i]), thousandths(grid.y[i]), thousandths(grid.z[i]));
      if (std::isnan(grid.z[i]) || !inside.contains(p.x(), p.y())) continue;
      if (count == 0) {
        points.origin = (p / 1000).array().round();
        origin = points.origin * 1000;
      }
      points.xyz[count] = ((p - origin) * 0.001).cast<float>();
      points.normal[count] = rule.at(&grid.z[i], grid.width);
      ++count;
    }
  }
  points.xyz.resize(count);
  points.normal.resize(count);
}

}  // namespace priormap
