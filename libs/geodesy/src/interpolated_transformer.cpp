#include <priormap/geodesy/interpolated_transformer.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace priormap {
namespace {

constexpr double metres_per_degree = 111320;
constexpr double cell_size_m = 4096;
constexpr double rounding_m = 1e-6;   // of PROJ's own iterations
constexpr std::size_t most_cells = 4096;   // 1 MB

double unit_m(const Crs& crs) { return crs.is_geographic() ? metres_per_degree : crs.horizontal_unit_m(); }

/// A power of two, so that places on the lattice are exact.
double cells_per_unit(const Crs& crs) { return std::exp2(std::round(std::log2(unit_m(crs) / cell_size_m))); }

/// Monomial coefficients in u of the cubic through the values at u = -1, 0, 1, 2.
template <class Value>
std::array<Value, 4> cubic(const Value& a, const Value& b, const Value& c, const Value& d) {
  return {b, c - a / 3 - b / 2 - d / 6, (a + c) / 2 - b, (d - a) / 6 + (b - c) / 2};
}

/// The images of a cell's corners and of two more nodes on each side: at(i, j) with i, j in [-2, 3].
class Nodes {
 public:
  explicit Nodes(std::span<const Eigen::Vector3d> images) : images_(images) {}

  Eigen::Vector2d at(int i, int j) const { return images_[static_cast<std::size_t>((j + 2) * 6 + i + 2)].head<2>(); }
  bool all_finite() const {
    return std::all_of(images_.begin(), images_.end(), [](const Eigen::Vector3d& p) { return p.allFinite(); });
  }

  /// The remainder of the cubic is 3/128 of the fourth difference (times the Lebesgue constant 5/4 for the second direction);
  /// 1/2 leaves room for fourth derivatives that grow between the nodes.
  double remainder() const {
    double along_x = 0, along_y = 0;
    for (int across = -1; across <= 2; ++across)
      for (int middle = 0; middle <= 1; ++middle) {
        along_x = std::max(along_x, fourth_difference(middle, across, 1, 0));
        along_y = std::max(along_y, fourth_difference(across, middle, 0, 1));
      }
    return 0.5 * (along_x + 1.25 * along_y);
  }

 private:
  double fourth_difference(int i, int j, int di, int dj) const {
    return (at(i - 2 * di, j - 2 * dj) - 4 * at(i - di, j - dj) + 6 * at(i, j) - 4 * at(i + di, j + dj) + at(i + 2 * di, j + 2 * dj)).norm();
  }

  std::span<const Eigen::Vector3d> images_;
};

}  // namespace

Eigen::Vector2d InterpolatedTransformer::Cell::at(double u, double v) const {
  const auto row = [&](std::size_t r) -> Eigen::Vector2d {
    return coefficients[r] + u * (coefficients[r + 1] + u * (coefficients[r + 2] + u * coefficients[r + 3]));
  };
  return row(0) + v * (row(4) + v * (row(8) + v * row(12)));
}

std::size_t InterpolatedTransformer::KeyHash::operator()(Key key) const {
  return (std::uint64_t(std::uint32_t(key.i)) << 32 | std::uint32_t(key.j)) * 0x9e3779b97f4a7c15u >> 20;
}

InterpolatedTransformer::InterpolatedTransformer(const Transformer& exact, Direction direction)
    : exact_(exact),
      direction_(direction),
      is_smooth_(!exact.is_identity() && exact.operation().grids.empty() && !exact.transforms_heights()),
      cells_per_unit_(cells_per_unit(direction == Direction::forward ? exact.source() : exact.target())),
      target_unit_m_(unit_m(direction == Direction::forward ? exact.target() : exact.source())),
      height_factor_(direction == Direction::forward ? exact.height_factor() : 1 / exact.height_factor()) {}

void InterpolatedTransformer::apply_exact(std::span<Eigen::Vector3d> points) const {
  direction_ == Direction::forward ? exact_.forward(points) : exact_.inverse(points);
}

InterpolatedTransformer::Cell InterpolatedTransformer::make_cell(Key key) const {
  std::vector<Eigen::Vector3d> images;
  for (int j = -2; j <= 3; ++j)
    for (int i = -2; i <= 3; ++i) images.emplace_back((double(key.i) + i) / cells_per_unit_, (double(key.j) + j) / cells_per_unit_, 0);
  apply_exact(images);
  const Nodes nodes(images);
  Cell cell;
  if (!nodes.all_finite()) return cell;

  std::array<std::array<Eigen::Vector2d, 4>, 4> along_x;
  for (int row = 0; row < 4; ++row)
    along_x[std::size_t(row)] = cubic(nodes.at(-1, row - 1), nodes.at(0, row - 1), nodes.at(1, row - 1), nodes.at(2, row - 1));
  for (std::size_t power = 0; power < 4; ++power) {
    const auto along_y = cubic(along_x[0][power], along_x[1][power], along_x[2][power], along_x[3][power]);
    for (std::size_t row = 0; row < 4; ++row) cell.coefficients[4 * row + power] = along_y[row];
  }
  const double bound_m = nodes.remainder() * target_unit_m_;
  // The remainder is greatest there: where it is more than the bound, the operation is not as smooth as it looked.
  cell.is_exact = !(bound_m <= tolerance_m && error_at_middles(cell, key) * target_unit_m_ <= std::max(bound_m, rounding_m));
  return cell;
}

double InterpolatedTransformer::error_at_middles(const Cell& cell, Key key) const {
  constexpr std::array<std::array<double, 2>, 5> middles = {{{0.5, 0.5}, {0, 0.5}, {1, 0.5}, {0.5, 0}, {0.5, 1}}};
  std::vector<Eigen::Vector3d> images;
  for (const auto& [u, v] : middles) images.emplace_back((key.i + u) / cells_per_unit_, (key.j + v) / cells_per_unit_, 0);
  apply_exact(images);
  double worst = 0;
  for (std::size_t n = 0; n < middles.size(); ++n)
    worst = std::max(worst, (cell.at(middles[n][0], middles[n][1]) - images[n].head<2>()).norm());
  return worst;
}

/// Nothing where the place has no cell.
const InterpolatedTransformer::Cell* InterpolatedTransformer::cell_at(double cell_x, double cell_y, Key& key) {
  constexpr double farthest = 1 << 30;
  if (!(std::abs(cell_x) < farthest && std::abs(cell_y) < farthest)) return nullptr;
  key = {static_cast<std::int32_t>(std::floor(cell_x)), static_cast<std::int32_t>(std::floor(cell_y))};
  const auto found = cells_.find(key);
  if (found != cells_.end()) return &found->second;
  if (cells_.size() >= most_cells) cells_.clear();
  return &cells_.emplace(key, make_cell(key)).first->second;
}

void InterpolatedTransformer::apply(std::span<Eigen::Vector3d> points) {
  if (!is_smooth_) return apply_exact(points);
  const Cell* cell = nullptr;   // of the last point; the next is mostly there too
  Key key;
  for (Eigen::Vector3d& point : points) {
    const double x = point.x() * cells_per_unit_, y = point.y() * cells_per_unit_;
    double u = x - key.i, v = y - key.j;
    if (!cell || !(u >= 0 && u < 1 && v >= 0 && v < 1)) {
      cell = cell_at(x, y, key);
      u = x - key.i;
      v = y - key.j;
    }
    if (!cell || cell->is_exact) {
      apply_exact(std::span(&point, 1));
      continue;
    }
    point.head<2>() = cell->at(u, v);
    point.z() *= height_factor_;
  }
}

bool InterpolatedTransformer::interpolates_at(double x, double y) {
  Key key;
  const Cell* cell = is_smooth_ ? cell_at(x * cells_per_unit_, y * cells_per_unit_, key) : nullptr;
  return cell && !cell->is_exact;
}

}  // namespace priormap
