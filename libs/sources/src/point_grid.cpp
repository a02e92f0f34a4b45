#include "point_grid.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
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
void fill_work(PointGrid& grid, const Bounds2& area, const Eigen::Vector3d& origin) {
  const std::size_t width = grid.width - 2, height = grid.height - 2;
  for (auto& array : grid.work) array.resize(width * height);
  auto& [x, y, z, nx, ny, nz] = grid.work;
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
}

/// Where the points of each column go; after the last one their number.
std::vector<std::uint32_t> places_of_columns(const std::vector<float>& z, std::size_t width) {
  std::vector<std::uint32_t> places(width + 1, 0);
  for (std::size_t i = 0; i < z.size(); i += width)
    for (std::size_t col = 0; col < width; ++col) places[col + 1] += z[i + col] == z[i + col];
  std::partial_sum(places.begin(), places.end(), places.begin());
  return places;
}

/// Adds the points of the walls that a grid has.
class WallBuilder {
 public:
  WallBuilder(const PointGrid& grid, const StepWalls& walls, const Bounds2& area, PointCloud& points) : grid_(grid), walls_(walls), area_(area), points_(points) {}

  /// @param across  a unit vector in the plane, from neighbour `a` to `b`
  void between(std::size_t a, std::size_t b, const Eigen::Vector2f& across) {
    const double step = grid_.z[b] - grid_.z[a];
    if (!(std::abs(step) > walls_.least_step)) return;
    const double x = thousandths(0.5 * (grid_.x[a] + grid_.x[b])), y = thousandths(0.5 * (grid_.y[a] + grid_.y[b]));
    if (x < thousandths(area_.min_x) || x >= thousandths(area_.max_x) || y < thousandths(area_.min_y) || y >= thousandths(area_.max_y)) return;
    const Eigen::Vector2f outward = step < 0 ? across : Eigen::Vector2f(-across);
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(std::abs(step) / walls_.rise)));
    for (std::size_t i = 0; i < count; ++i) {
      const double z = thousandths(grid_.z[a] + step * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
      points_.xyz.push_back(((Eigen::Vector3d(x, y, z) - 1000 * points_.origin) / 1000).cast<float>());
      points_.normal.emplace_back(outward.x(), outward.y(), 0.0f);
    }
  }

 private:
  const PointGrid& grid_;
  const StepWalls& walls_;
  const Bounds2& area_;
  PointCloud& points_;
};

}  // namespace

void PointGrid::resize(std::size_t new_width, std::size_t new_height) {
  width = new_width;
  height = new_height;
  x.resize(size());
  y.resize(size());
  z.resize(size());
}

void points_of_grid(PointGrid& grid, const Bounds2& area, PointCloud& points) {
  points.clear();
  if (grid.width < 3 || grid.height < 3) return;
  const auto origin = origin_of(grid);
  if (!origin) return;
  points.origin = *origin;
  fill_work(grid, area, *origin);
  const std::size_t width = grid.width - 2, height = grid.height - 2;
  std::vector<std::uint32_t> places = places_of_columns(grid.work[2], width);
  points.xyz.resize(places.back());
  points.normal.resize(places.back());
  const float *x = grid.work[0].data(), *y = grid.work[1].data(), *z = grid.work[2].data();
  const float *nx = grid.work[3].data(), *ny = grid.work[4].data(), *nz = grid.work[5].data();
  Eigen::Vector3f *xyz = points.xyz.data(), *normal = points.normal.data();
  std::uint32_t* place = places.data();
  constexpr std::size_t stripe = 16;   // columns that share a line of the cache
  for (std::size_t left = 0; left < width; left += stripe)
    for (std::size_t row = height; row-- > 0;)
      for (std::size_t col = left, i = row * width + left; col < std::min(left + stripe, width); ++col, ++i) {
        if (std::isnan(z[i])) continue;
        const std::uint32_t to = place[col]++;
        xyz[to] = {x[i], y[i], z[i]};
        normal[to] = {nx[i], ny[i], nz[i]};
      }
}

void walls_of_grid(const PointGrid& grid, const StepWalls& walls, const Bounds2& area, PointCloud& points) {
  points.clear();
  if (grid.width < 3 || grid.height < 3) return;
  const auto origin = origin_of(grid);
  if (!origin) return;
  points.origin = *origin;
  WallBuilder builder(grid, walls, area, points);
  const Eigen::Vector2f along = grid.along.normalized().cast<float>(), down = grid.down.normalized().cast<float>();
  for (std::size_t row = 1; row + 1 < grid.height; ++row)
    for (std::size_t i = row * grid.width + 1; i + 1 < (row + 1) * grid.width; ++i) {
      builder.between(i, i + 1, along);
      builder.between(i, i + grid.width, down);
    }
}

}  // namespace priormap
