#include "point_grid.hpp"

#include <array>
#include <limits>
#include <optional>

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
/// differ by more than `limit`, or the one that is known. NaN where neither is. Without branches, for a row at once.
inline float height_step(double before, double z, double after, float limit) {
  const auto in = static_cast<float>(z - before), out = static_cast<float>(after - z);
  const float flatter = std::abs(in) <= std::abs(out) ? in : out;
  const float known = in == in ? (out == out ? flatter : in) : out;
  return std::abs(in - out) <= limit ? 0.5f * (in + out) : known;
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

  /// (along, step) x (down, step), upwards, of `count` points in a row; zero where a step is not known.
  void of_row(const double* z, std::size_t grid_width, std::size_t count, float* nx, float* ny, float* nz) const {
    const double *above = z - grid_width, *below = z + grid_width;
    const float along_x = along_.x(), along_y = along_.y(), down_x = down_.x(), down_y = down_.y();
    const float up = up_, limit_along = limit_along_, limit_down = limit_down_, sign = sign_;
    for (std::size_t i = 0; i < count; ++i) {
      const float a = height_step(z[i - 1], z[i], z[i + 1], limit_along), d = height_step(above[i], z[i], below[i], limit_down);
      const float x = along_y * d - a * down_y, y = a * down_x - along_x * d;
      const float scale = sign / std::sqrt(x * x + y * y + up * up);
      const bool known = scale == scale;
      nx[i] = known ? x * scale : 0;
      ny[i] = known ? y * scale : 0;
      nz[i] = known ? up * scale : 0;
    }
  }

 private:
  Eigen::Vector2f along_, down_;
  float up_, limit_along_, limit_down_, sign_;
};

/// Coordinates of a row in float32 from an origin in thousandths.
void offsets_of_row(const double* v, std::size_t count, double origin, float* offsets) {
  for (std::size_t i = 0; i < count; ++i) offsets[i] = static_cast<float>((thousandths(v[i]) - origin) * 0.001);
}

/// NaN where a coordinate lies outside of [min, max), in thousandths.
void clear_outside(const double* v, std::size_t count, double min, double max, float* offsets) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < count; ++i) {
    const double rounded = thousandths(v[i]);
    const bool inside = (rounded >= min) & (rounded < max);
    offsets[i] = inside ? offsets[i] : none;
  }
}

/// Near the first point with a height, in whole units; nothing where there is none.
std::optional<Eigen::Vector3d> origin_of(const PointGrid& grid) {
  for (std::size_t row = 1; row + 1 < grid.height; ++row)
    for (std::size_t i = row * grid.width + 1; i + 1 < (row + 1) * grid.width; ++i)
      if (!std::isnan(grid.z[i])) return Eigen::Vector3d(grid.x[i], grid.y[i], grid.z[i]).array().round();
  return std::nullopt;
}

/// x, y, z (NaN: no point) and the normal of a grid's inner points, one array each, row by row.
using Arrays = std::array<std::vector<float>, 6>;

Arrays row_arrays(const PointGrid& grid, const Bounds2& area, const Eigen::Vector3d& origin) {
  const std::size_t width = grid.width - 2, height = grid.height - 2;
  Arrays arrays;
  for (auto& array : arrays) array.resize(width * height);
  auto& [x, y, z, nx, ny, nz] = arrays;
  const Eigen::Vector3d zero = origin * 1000;
  const NormalRule normals(grid);
  for (std::size_t row = 0; row < height; ++row) {
    const std::size_t from = (row + 1) * grid.width + 1, to = row * width;
    offsets_of_row(&grid.x[from], width, zero.x(), &x[to]);
    offsets_of_row(&grid.y[from], width, zero.y(), &y[to]);
    offsets_of_row(&grid.z[from], width, zero.z(), &z[to]);
    clear_outside(&grid.x[from], width, thousandths(area.min_x), thousandths(area.max_x), &z[to]);
    clear_outside(&grid.y[from], width, thousandths(area.min_y), thousandths(area.max_y), &z[to]);
    normals.of_row(&grid.z[from], grid.width, width, &nx[to], &ny[to], &nz[to]);
  }
  return arrays;
}

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
  const auto origin = origin_of(grid);
  if (!origin) return;
  points.origin = *origin;
  const auto [x, y, z, nx, ny, nz] = row_arrays(grid, area, *origin);
  const std::size_t width = grid.width - 2, height = grid.height - 2;
  points.xyz.resize(width * height);
  points.normal.resize(width * height);
  std::size_t count = 0;
  for (std::size_t col = 0; col < width; ++col) {
    for (std::size_t row = height; row-- > 0;) {
      const std::size_t i = row * width + col;
      points.xyz[count] = {x[i], y[i], z[i]};
      points.normal[count] = {nx[i], ny[i], nz[i]};
      count += z[i] == z[i];
    }
  }
  points.xyz.resize(count);
  points.normal.resize(count);
}

}  // namespace priormap
