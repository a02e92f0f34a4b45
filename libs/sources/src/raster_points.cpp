#include <priormap/sources/raster_points.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include <priormap/core/also_avx2.hpp>
#include <priormap/core/error.hpp>
#include <priormap/geodesy/image_bounds.hpp>
#include <priormap/geodesy/interpolated_transformer.hpp>

#include "point_grid.hpp"
#include "raster_area.hpp"
#include "raster_file.hpp"

namespace priormap {
namespace {

/// Cells along the edge of one grid; and of a patch with normals of its own orientation, in another CRS, where it reaches no farther than this. A stripe from north to south stays in the cache.
constexpr int grid_edge = 512, patch_edge = 128, stripe_width = 32, margin = static_cast<int>(PointGrid::margin);
constexpr double patch_extent = 2048;

/// Transforms positions with a height in place; where that fails the height is lost.
void transform_known(InterpolatedTransformer& transformer, PointGrid& grid, std::vector<Eigen::Vector3d>& buffer) {
  buffer.clear();
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (!std::isnan(grid.z[i])) buffer.emplace_back(grid.x[i], grid.y[i], grid.z[i]);
  transformer.apply(buffer);
  auto moved = buffer.begin();
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (std::isnan(grid.z[i])) continue;
    const bool usable = moved->allFinite();
    grid.x[i] = moved->x();
    grid.y[i] = moved->y();
    grid.z[i] = usable ? moved->z() : std::numeric_limits<double>::quiet_NaN();
    ++moved;
  }
}

/// Around the images of those places of an area that have one, with one step between places more on each side; empty where none has.
Eigen::AlignedBox2d known_image(const Bounds2& area, InterpolatedTransformer& transformer) {
  constexpr int steps = 32;
  std::vector<Eigen::Vector3d> places;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i)
      places.emplace_back(area.min_x + (area.max_x - area.min_x) * i / steps, area.min_y + (area.max_y - area.min_y) * j / steps, 0);
  transformer.apply(places);
  Eigen::AlignedBox2d box;
  double longest_step = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i].allFinite()) continue;
    box.extend(places[i].head<2>());
    if (i % (steps + 1) > 0 && places[i - 1].allFinite()) longest_step = std::max(longest_step, (places[i] - places[i - 1]).head<2>().norm());
    if (i > steps && places[i - steps - 1].allFinite()) longest_step = std::max(longest_step, (places[i] - places[i - steps - 1]).head<2>().norm());
  }
  if (!box.isEmpty()) box = {box.min().array() - longest_step, box.max().array() + longest_step};
  return box;
}

/// Where the whole raster lies in the target CRS; nothing where it reaches so far beyond its domain that its image says nothing.
std::optional<Bounds2> target_bounds(const RasterFacts& facts, double target_cell_size, InterpolatedTransformer& transformer) {
  if (const auto image = image_bounds(facts.bounds, [&](std::span<Eigen::Vector3d> points) { transformer.apply(points); })) return image->outer;
  const Eigen::AlignedBox2d known = known_image(facts.bounds, transformer);
  constexpr double most = 10;
  if (known.isEmpty() || known.volume() > most * facts.width * facts.height * target_cell_size * target_cell_size) return std::nullopt;
  return Bounds2{known.min().x(), known.min().y(), known.max().x(), known.max().y()};
}

/// Walls of cells that are near enough to each other to tell where they stand. @param cell_size  of the raster, in the unit of the target CRS
std::optional<StepWalls> step_walls(const Crs& target, double cell_size, const std::optional<double>& least_wall_m) {
  constexpr double coarsest_m = 2.5, greatest_rise_m = 1;
  constexpr double highest_m = 1000;   // no building and no cliff rises so far from one cell to the next
  const double cell_m = cell_size * target.horizontal_unit_m(), unit_m = std::abs(target.vertical_unit_m());
  if (!least_wall_m || cell_m > coarsest_m) return std::nullopt;
  return StepWalls{std::max(*least_wall_m, cell_m) / unit_m, highest_m / unit_m, std::min(cell_m, greatest_rise_m) / unit_m};
}

/// The centres of a column's cells from row `south` up.
PRIORMAP_ALSO_AVX2 void line_of_centres(const Eigen::Affine2d& world_from_cell, int col, int south, std::span<double> x, std::span<double> y) {
  const auto& m = world_from_cell.matrix();
  const double x_of_row = m(0, 1), y_of_row = m(1, 1), x_of_col = m(0, 0) * (col + 0.5), y_of_col = m(1, 0) * (col + 0.5), x_0 = m(0, 2), y_0 = m(1, 2);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double row = south - static_cast<int>(i) + 0.5;
    x[i] = x_0 + (x_of_col + x_of_row * row);
    y[i] = y_0 + (y_of_col + y_of_row * row);
  }
}

/// The raster's own cell centres.
class CellSampling {
 public:
  CellSampling(const std::filesystem::path& file, const Crs& source, const Crs& target, const std::optional<double>& least_wall_m)
      : CellSampling(RasterFile(file, source), source, target, least_wall_m) {}

  const std::optional<Bounds2>& bounds() const { return bounds_; }
  const CoordinateOperation& operation() const { return transformer_.exact().operation(); }
  double cell_size() const { return cell_size_; }
  ImpossibleHeights impossible_heights() const { return raster_.impossible_heights(); }

  void read(const Bounds2& area, const LasPoint& common, const RasterPoints::Visit& visit) {
    for_each_grid(area, [&] { points_of_grid(grid_, walls_, area, common, visit); });
  }
  void read_walls(const Bounds2& area, const LasPoint& common, const RasterPoints::Visit& visit) {
    if (walls_) for_each_grid(area, [&] { walls_of_grid(grid_, *walls_, area, common, visit); });
  }

 private:
  CellSampling(RasterFile raster, const Crs& source, const Crs& target, const std::optional<double>& least_wall_m)
      : raster_(std::move(raster)),
        transformer_(target_from_raster(raster_.facts(), source, target)),
        back_(transformer_.exact(), InterpolatedTransformer::Direction::inverse) {
    const RasterFacts& facts = raster_.facts();
    cell_size_ = target_cell_size(raster_, transformer_.exact());
    const double longer = cell_size_ * std::sqrt(std::max(facts.cell_x / facts.cell_y, facts.cell_y / facts.cell_x));
    const int most_patch = static_cast<int>(std::clamp(patch_extent / longer, 1.0, static_cast<double>(patch_edge)));
    patch_width_ = is_identity() ? stripe_width : most_patch;
    patch_height_ = is_identity() ? grid_edge : most_patch;
    bounds_ = target_bounds(facts, cell_size_, transformer_);
    walls_ = step_walls(target, cell_size_, least_wall_m);
  }

  bool is_identity() const { return transformer_.exact().is_identity(); }

  /// All cells whose centres may come to lie inside of the area.
  CellWindow window_over(const Bounds2& area) {
    Bounds2 b = area;
    if (!is_identity()) {
      if (const auto image = image_bounds(area, [&](std::span<Eigen::Vector3d> points) { back_.apply(points); })) {
        b = image->outer;
      } else {
        const Eigen::AlignedBox2d known = known_image(area, back_);
        if (known.isEmpty()) return {};
        b = {known.min().x(), known.min().y(), known.max().x(), known.max().y()};
      }
    }
    const Eigen::Affine2d cell_from_world = raster_.world_from_cell().inverse();
    Eigen::AlignedBox2d cells;
    for (const Eigen::Vector2d& corner : {Eigen::Vector2d(b.min_x, b.min_y), Eigen::Vector2d(b.max_x, b.min_y), Eigen::Vector2d(b.min_x, b.max_y), Eigen::Vector2d(b.max_x, b.max_y)})
      cells.extend(cell_from_world * corner);
    // Interpolation and rounding may move a centre across the edge of the area; and the wall beside it stands half a cell on.
    constexpr double hair = 0.75;
    const auto first = [&](double v, int size) { return static_cast<int>(std::clamp(std::ceil(v - 0.5 - hair), 0.0, static_cast<double>(size))); };
    const auto last = [&](double v, int size) { return static_cast<int>(std::clamp(std::floor(v - 0.5 + hair) + 1, 0.0, static_cast<double>(size))); };
    const int col = first(cells.min().x(), raster_.facts().width), row = first(cells.min().y(), raster_.facts().height);
    return {col, row, last(cells.max().x(), raster_.facts().width) - col, last(cells.max().y(), raster_.facts().height) - row};
  }

  /// Calls use() for each part of an area, with the part's cells in grid_.
  template <class Use>
  void for_each_grid(const Bounds2& area, const Use& use) {
    const CellWindow window = window_over(area);
    if (window.width <= 0 || window.height <= 0) return;
    held_ = grown(window);
    heights_.resize(static_cast<std::size_t>(held_.width) * static_cast<std::size_t>(held_.height));
    raster_.read(held_, heights_);
    for_each_patch(window, [&](const CellWindow& patch, const CellWindow& part) {
      fill_grid(part);
      if (!is_identity()) transform_grid(patch);
      use();
    });
  }

  /// Calls visit(patch, its part in the window). Patches of a raster in another CRS do not depend on the window: their normals share an orientation.
  template <class Visit>
  void for_each_patch(const CellWindow& w, const Visit& visit) const {
    const auto first = [&](int v, int edge) { return is_identity() ? v : v / edge * edge; };
    for (int row = first(w.row, patch_height_); row < w.row + w.height; row += patch_height_) {
      for (int col = first(w.col, patch_width_); col < w.col + w.width; col += patch_width_) {
        const CellWindow patch{col, row, std::min(patch_width_, raster_.facts().width - col), std::min(patch_height_, raster_.facts().height - row)};
        const int left = std::max(col, w.col), top = std::max(row, w.row);
        visit(patch, CellWindow{left, top, std::min(col + patch.width, w.col + w.width) - left, std::min(row + patch.height, w.row + w.height) - top});
      }
    }
  }

  /// With the margin of a grid, as far as the raster goes.
  CellWindow grown(const CellWindow& w) const {
    const int left = std::max(0, w.col - margin), top = std::max(0, w.row - margin);
    const int right = std::min(raster_.facts().width, w.col + w.width + margin), bottom = std::min(raster_.facts().height, w.row + w.height + margin);
    return {left, top, right - left, bottom - top};
  }

  /// Positions with a height go to the target CRS; the steps between cells become those at the middle of the patch.
  void transform_grid(const CellWindow& patch) {
    const Eigen::Vector2d middle = raster_.world_from_cell() * Eigen::Vector2d(patch.col + patch.width / 2 + 0.5, patch.row + patch.height / 2 + 0.5);
    std::array<Eigen::Vector3d, 3> p;
    p[0] << middle, 0;
    p[1] << middle + grid_.across, 0;
    p[2] << middle + grid_.back, 0;
    transformer_.exact().forward(p);
    grid_.across = (p[1] - p[0]).head<2>();
    grid_.back = (p[2] - p[0]).head<2>();
    transform_known(transformer_, grid_, buffer_);
  }

  void fill_grid(const CellWindow& window) {
    grid_.resize(static_cast<std::size_t>(window.width + 2 * margin), static_cast<std::size_t>(window.height + 2 * margin));
    const Eigen::Affine2d& world_from_cell = raster_.world_from_cell();
    grid_.across = world_from_cell.linear().col(0);
    grid_.back = world_from_cell.linear().col(1);
    const int south = window.row + window.height + margin - 1;   // the first place of each line
    const auto length = static_cast<int>(grid_.length);
    const int first_held = std::clamp(south - held_.row - held_.height + 1, 0, length), last_held = std::clamp(south - held_.row + 1, first_held, length);
    for (std::size_t line = 0; line < grid_.lines; ++line) {
      const int col = window.col - margin + static_cast<int>(line), held_col = col - held_.col;
      const std::size_t start = line * grid_.length;
      line_of_centres(world_from_cell, col, south, std::span(grid_.x).subspan(start, grid_.length), std::span(grid_.y).subspan(start, grid_.length));
      double* z = &grid_.z[start];
      std::fill_n(z, grid_.length, std::numeric_limits<double>::quiet_NaN());
      if (held_col < 0 || held_col >= held_.width) continue;
      for (int i = first_held; i < last_held; ++i)
        z[i] = heights_[static_cast<std::size_t>(south - i - held_.row) * static_cast<std::size_t>(held_.width) + static_cast<std::size_t>(held_col)];
    }
  }

  RasterFile raster_;
  InterpolatedTransformer transformer_, back_;
  double cell_size_ = 0;
  int patch_width_ = 0, patch_height_ = 0;
  std::optional<Bounds2> bounds_;
  std::optional<StepWalls> walls_;
  CellWindow held_;   ///< whose heights are these:
  std::vector<double> heights_;
  PointGrid grid_;
  std::vector<Eigen::Vector3d> buffer_;
};

/// Cells of a square lattice of the target CRS: node (i, j) at ((i + 0.5) s, (j + 0.5) s), so that none lies on the edge of a tile. Walls are those of the raster's own cells:
/// what is interpolated between two of them makes slopes of a step, or two lower steps.
class LatticeSampling {
 public:
  LatticeSampling(const std::filesystem::path& file, const Crs& source, const Crs& target, double spacing, const std::optional<double>& least_wall_m)
      : raster_(HeightRaster::open(file, source, target)), cells_(file, source, target, least_wall_m), spacing_(spacing) {
    const RasterFacts facts = read_raster_facts(file);
    InterpolatedTransformer horizontal(target_from_raster(facts, source.horizontal(), target.horizontal()));
    bounds_ = target_bounds(facts, raster_.cell_size(), horizontal);
  }

  const std::optional<Bounds2>& bounds() const { return bounds_; }
  const CoordinateOperation& operation() const { return cells_.operation(); }
  double cell_size() const { return raster_.cell_size(); }
  ImpossibleHeights impossible_heights() const {
    const ImpossibleHeights of_lattice = raster_.impossible_heights();
    return of_lattice.cells > 0 ? of_lattice : cells_.impossible_heights();
  }

  void read(const Bounds2& area, const LasPoint& common, const RasterPoints::Visit& visit) {
    const auto first = [&](double v) { return static_cast<std::int64_t>(std::floor(v / spacing_ - 0.5)); };
    const auto last = [&](double v) { return static_cast<std::int64_t>(std::ceil(v / spacing_ - 0.5)) + 1; };
    const Bounds2 known = bounds_.value_or(area);
    const std::int64_t end_i = last(std::min(area.max_x, known.max_x)), end_j = last(std::min(area.max_y, known.max_y));
    for (std::int64_t j = first(std::max(area.min_y, known.min_y)); j < end_j; j += grid_edge) {
      for (std::int64_t i = first(std::max(area.min_x, known.min_x)); i < end_i; i += stripe_width) {
        fill_grid(i, j, std::min<std::int64_t>(stripe_width, end_i - i), std::min<std::int64_t>(grid_edge, end_j - j));
        points_of_grid(grid_, std::nullopt, area, common, visit);
      }
    }
    cells_.read_walls(area, common, visit);
  }

 private:
  void fill_grid(std::int64_t first_i, std::int64_t first_j, std::int64_t width, std::int64_t height) {
    grid_.resize(static_cast<std::size_t>(width + 2 * margin), static_cast<std::size_t>(height + 2 * margin));
    grid_.across = {spacing_, 0};
    grid_.back = {0, -spacing_};
    std::size_t k = 0;
    for (std::int64_t i = first_i - margin; i < first_i + width + margin; ++i) {
      for (std::int64_t j = first_j - margin; j < first_j + height + margin; ++j, ++k) {
        grid_.x[k] = (static_cast<double>(i) + 0.5) * spacing_;
        grid_.y[k] = (static_cast<double>(j) + 0.5) * spacing_;
        grid_.z[k] = raster_.at(grid_.x[k], grid_.y[k]).value_or(std::numeric_limits<double>::quiet_NaN());
      }
    }
  }

  HeightRaster raster_;
  CellSampling cells_;
  double spacing_;
  std::optional<Bounds2> bounds_;
  PointGrid grid_;
};

using Sampling = std::variant<CellSampling, LatticeSampling>;

Sampling make_sampling(const std::filesystem::path& file, const Crs& source, const Crs& target, const std::optional<double>& spacing, const std::optional<double>& least_wall_m) {
  try {
    if (spacing) return LatticeSampling(file, source, target, *spacing, least_wall_m);
    return CellSampling(file, source, target, least_wall_m);
  } catch (const CrsError& error) {
    const std::string message = error.what();
    throw CrsError(message.starts_with(file.string()) ? message : file.string() + ": " + message);
  }
}

}  // namespace

struct RasterPoints::Impl {
  Sampling sampling;
};

RasterPoints::RasterPoints(const std::filesystem::path& file, const Crs& source, const Crs& target, const std::optional<double>& spacing,
                           const std::optional<double>& least_wall_m)
    : impl_(new Impl{make_sampling(file, source, target, spacing, least_wall_m)}) {}
RasterPoints::RasterPoints(const RasterPoints& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
RasterPoints& RasterPoints::operator=(const RasterPoints& other) { return *this = RasterPoints(other); }
RasterPoints::RasterPoints(RasterPoints&&) noexcept = default;
RasterPoints& RasterPoints::operator=(RasterPoints&&) noexcept = default;
RasterPoints::~RasterPoints() = default;

void RasterPoints::read(const Bounds2& area, const LasPoint& common, const Visit& visit) {
  std::visit([&](auto& sampling) { sampling.read(area, common, visit); }, impl_->sampling);
}

const std::optional<Bounds2>& RasterPoints::bounds() const {
  return std::visit([](const auto& sampling) -> const std::optional<Bounds2>& { return sampling.bounds(); }, impl_->sampling);
}

double RasterPoints::cell_size() const {
  return std::visit([](const auto& sampling) { return sampling.cell_size(); }, impl_->sampling);
}

ImpossibleHeights RasterPoints::impossible_heights() const {
  return std::visit([](const auto& sampling) { return sampling.impossible_heights(); }, impl_->sampling);
}

const CoordinateOperation& RasterPoints::operation() const {
  return std::visit([](const auto& sampling) -> const CoordinateOperation& { return sampling.operation(); }, impl_->sampling);
}

}  // namespace priormap
