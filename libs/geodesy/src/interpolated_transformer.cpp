#include <priormap/geodesy/interpolated_transformer.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace priormap {
namespace {

constexpr int first_cells = 4, most_cells = 1024;   // along the longer side
constexpr double metres_per_degree = 111320;
constexpr double rounding_m = 1e-6;   // of PROJ's own iterations

double target_unit_m(const Transformer& exact) {
  return exact.target().is_geographic() ? metres_per_degree : exact.target().horizontal_unit_m();
}

bool is_smooth(const Transformer& exact) { return exact.operation().grids.empty() && !exact.transforms_heights(); }

/// Monomial coefficients in u of the cubic through the values at u = -1, 0, 1, 2.
template <class Value>
std::array<Value, 4> cubic(const Value& a, const Value& b, const Value& c, const Value& d) {
  return {b, c - a / 3 - b / 2 - d / 6, (a + c) / 2 - b, (d - a) / 6 + (b - c) / 2};
}

}  // namespace

/// Images of a regular grid that reaches one cell beyond the region on each side.
struct InterpolatedTransformer::Nodes {
  Nodes(const Transformer& exact, const Bounds2& region, Eigen::Array2i cell_count)
      : count(cell_count), origin(region.min_x, region.min_y),
        step((region.max_x - region.min_x) / cell_count.x(), (region.max_y - region.min_y) / cell_count.y()) {
    std::vector<Eigen::Vector3d> points;
    for (int j = -1; j <= count.y() + 1; ++j)
      for (int i = -1; i <= count.x() + 1; ++i) points.emplace_back(origin.x() + i * step.x(), origin.y() + j * step.y(), 0);
    exact.forward(points);
    for (const Eigen::Vector3d& point : points) images.push_back(point.head<2>());
  }

  const Eigen::Vector2d& at(int i, int j) const { return images[static_cast<std::size_t>((j + 1) * (count.x() + 3) + i + 1)]; }
  bool all_finite() const {
    return std::all_of(images.begin(), images.end(), [](const Eigen::Vector2d& image) { return image.allFinite(); });
  }

  /// Greatest fourth difference along x and along y.
  Eigen::Array2d fourth_differences() const {
    Eigen::Array2d greatest = Eigen::Array2d::Zero();
    for (int j = -1; j <= count.y() + 1; ++j)
      for (int i = 1; i <= count.x() - 1; ++i)
        greatest.x() = std::max(greatest.x(), (at(i - 2, j) - 4 * at(i - 1, j) + 6 * at(i, j) - 4 * at(i + 1, j) + at(i + 2, j)).norm());
    for (int j = 1; j <= count.y() - 1; ++j)
      for (int i = -1; i <= count.x() + 1; ++i)
        greatest.y() = std::max(greatest.y(), (at(i, j - 2) - 4 * at(i, j - 1) + 6 * at(i, j) - 4 * at(i, j + 1) + at(i, j + 2)).norm());
    return greatest;
  }

  /// The remainder of the cubic is 3/128 of the fourth difference (times the Lebesgue constant 5/4 for the second direction);
  /// 1/2 leaves room for fourth derivatives that grow between the nodes.
  double remainder() const {
    const Eigen::Array2d differences = fourth_differences();
    return 0.5 * (differences.x() + 1.25 * differences.y());
  }

  Eigen::Array2i count;
  Eigen::Vector2d origin, step;
  std::vector<Eigen::Vector2d> images;
};

double InterpolatedTransformer::error_at_centres(const Transformer& exact, const Cells& grid) {
  std::vector<Eigen::Vector3d> centres;
  for (int j = 0; j < grid.count.y(); ++j)
    for (int i = 0; i < grid.count.x(); ++i)
      centres.emplace_back(grid.origin.x() + (i + 0.5) / grid.cells_per_unit.x(), grid.origin.y() + (j + 0.5) / grid.cells_per_unit.y(), 0);
  std::vector<Eigen::Vector3d> images = centres;
  exact.forward(images);
  double worst = 0;
  for (std::size_t n = 0; n < centres.size(); ++n)
    worst = std::max(worst, (grid.cells[n].at(0.5, 0.5) - images[n].head<2>()).norm());
  return worst;
}

std::shared_ptr<const InterpolatedTransformer::Cells> InterpolatedTransformer::make_cells(const Nodes& nodes, double error_bound_m) {
  auto cells = std::make_shared<Cells>();
  cells->origin = nodes.origin;
  cells->cells_per_unit = nodes.step.cwiseInverse();
  cells->count = nodes.count;
  cells->error_bound_m = error_bound_m;
  for (int j = 0; j < nodes.count.y(); ++j)
    for (int i = 0; i < nodes.count.x(); ++i) {
      std::array<std::array<Eigen::Vector2d, 4>, 4> along_x;
      for (int row = 0; row < 4; ++row)
        along_x[row] = cubic(nodes.at(i - 1, j + row - 1), nodes.at(i, j + row - 1), nodes.at(i + 1, j + row - 1), nodes.at(i + 2, j + row - 1));
      Cell cell;
      for (int power = 0; power < 4; ++power) {
        const auto along_y = cubic(along_x[0][power], along_x[1][power], along_x[2][power], along_x[3][power]);
        for (int row = 0; row < 4; ++row) cell.coefficients[static_cast<std::size_t>(4 * row + power)] = along_y[row];
      }
      cells->cells.push_back(cell);
    }
  return cells;
}

std::shared_ptr<const InterpolatedTransformer::Cells> InterpolatedTransformer::refine(const Transformer& exact, const Bounds2& region,
                                                                                      double tolerance_m) {
  const double width = region.max_x - region.min_x, height = region.max_y - region.min_y;
  for (int cells = first_cells; cells <= most_cells; cells *= 2) {
    const double size = std::max(width, height) / cells;
    const Eigen::Array2i count(std::max(first_cells, static_cast<int>(std::ceil(width / size))),
                               std::max(first_cells, static_cast<int>(std::ceil(height / size))));
    const Nodes nodes(exact, region, count);
    if (!nodes.all_finite()) return nullptr;
    const double bound_m = nodes.remainder() * target_unit_m(exact);
    if (bound_m > tolerance_m) continue;
    const auto grid = make_cells(nodes, bound_m);
    // The remainder is greatest at the centres: where it is more than the bound, the operation is not as smooth as it looked.
    if (error_at_centres(exact, *grid) * target_unit_m(exact) <= std::max(bound_m, rounding_m)) return grid;
  }
  return nullptr;
}

InterpolatedTransformer::InterpolatedTransformer(const Transformer& exact, const Bounds2& region, double tolerance_m) : exact_(exact) {
  if (!exact.is_identity() && is_smooth(exact) && !region.empty()) cells_ = refine(exact, region, tolerance_m);
}

double InterpolatedTransformer::error_bound_m() const { return cells_ ? cells_->error_bound_m : 0; }

void InterpolatedTransformer::forward(std::span<Eigen::Vector3d> points) const {
  if (!cells_) return exact_.forward(points);
  const Cells& grid = *cells_;
  const double height_factor = exact_.height_factor();
  for (Eigen::Vector3d& point : points) {
    const double x = (point.x() - grid.origin.x()) * grid.cells_per_unit.x();
    const double y = (point.y() - grid.origin.y()) * grid.cells_per_unit.y();
    if (!(x >= 0 && y >= 0 && x <= grid.count.x() && y <= grid.count.y())) {
      exact_.forward(std::span(&point, 1));
      continue;
    }
    const int i = std::min(static_cast<int>(x), grid.count.x() - 1), j = std::min(static_cast<int>(y), grid.count.y() - 1);
    point.head<2>() = grid.cells[static_cast<std::size_t>(j * grid.count.x() + i)].at(x - i, y - j);
    point.z() *= height_factor;
  }
}

}  // namespace priormap
