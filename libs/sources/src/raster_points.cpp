#include <priormap/sources/raster_points.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/image_bounds.hpp>
#include <priormap/geodesy/interpolated_transformer.hpp>

#include "point_grid.hpp"
#include "raster_area.hpp"
#include "raster_file.hpp"

namespace priormap {
namespace {

/// A cloud reaches no farther than this from its origin, so that float32 keeps the millimetre lattice.
constexpr double cloud_extent = 2048;
/// Cells of one reading of the file, and of one cloud.
constexpr int block_cells = 1 << 18, cloud_edge = 128;

bool overlap(const Bounds2& a, const Bounds2& b) { return a.min_x < b.max_x && b.min_x < a.max_x && a.min_y < b.max_y && b.min_y < a.max_y; }

/// Whole strips or tiles of the file, about `block_cells` at once.
Eigen::Vector2i choose_block(const RasterFile& raster) {
  const Eigen::Vector2i natural = raster.natural_block();
  const int width = raster.facts().width, height = raster.facts().height;
  const auto multiple = [](int unit, int wanted) { return std::max(1, wanted / unit) * unit; };
  if (natural.x() >= width) return {width, std::min(height, multiple(std::min(natural.y(), height), std::clamp(block_cells / width, 16, 512)))};
  return {std::min(width, multiple(natural.x(), 512)), std::min(height, multiple(natural.y(), 512))};
}

/// Transforms positions with a height in place; where that fails the height is lost.
void transform_known(const InterpolatedTransformer& transformer, PointGrid& grid, std::vector<Eigen::Vector3d>& buffer) {
  buffer.clear();
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (!std::isnan(grid.z[i])) buffer.emplace_back(grid.x[i], grid.y[i], grid.z[i]);
  transformer.forward(buffer);
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

/// The raster's own cell centres.
class CellSampling {
 public:
  CellSampling(const std::filesystem::path& file, const Crs& source, const Crs& target, const std::optional<Bounds2>& within)
      : raster_(file), transformer_(Transformer(source, target, area_of(raster_.facts(), source)), raster_.facts().bounds), block_(choose_block(raster_)) {
    cell_size_ = target_cell_size(raster_, transformer_.exact());
    const double longer = cell_size_ * std::sqrt(std::max(raster_.facts().cell_x / raster_.facts().cell_y, raster_.facts().cell_y / raster_.facts().cell_x));
    cloud_edge_ = static_cast<int>(std::clamp(cloud_extent / longer, 1.0, static_cast<double>(cloud_edge)));
    plan(within ? needed_area(*within) : std::nullopt);
  }

  std::size_t num_blocks() const { return blocks_.size(); }
  const CoordinateOperation& operation() const { return transformer_.exact().operation(); }
  double cell_size() const { return cell_size_; }

  void read_block(std::size_t block, const std::function<void(PointCloud&)>& visit) {
    const CellWindow inner = blocks_[block];
    const CellWindow outer = grown(inner);
    heights_.resize(static_cast<std::size_t>(outer.width) * static_cast<std::size_t>(outer.height));
    raster_.read(outer, heights_);
    for (int row = inner.row; row < inner.row + inner.height; row += cloud_edge_) {
      for (int col = inner.col; col < inner.col + inner.width; col += cloud_edge_) {
        fill_grid({col, row, std::min(cloud_edge_, inner.col + inner.width - col), std::min(cloud_edge_, inner.row + inner.height - row)}, outer);
        if (!transformer_.exact().is_identity()) transform_grid();
        PointCloud points = points_of_grid(grid_);
        if (!points.empty()) visit(points);
      }
    }
  }

 private:
  /// Where cells of `within` lie in the raster's CRS.
  std::optional<Bounds2> needed_area(const Bounds2& within) const {
    const Transformer& exact = transformer_.exact();
    if (exact.is_identity()) return within;
    const auto image = image_bounds(within, Transformer(exact.target().horizontal(), exact.source().horizontal()));
    return image ? std::optional(image->outer) : std::nullopt;
  }

  void plan(const std::optional<Bounds2>& needed) {
    for (int row = 0; row < raster_.facts().height; row += block_.y()) {
      for (int col = 0; col < raster_.facts().width; col += block_.x()) {
        const CellWindow window{col, row, std::min(block_.x(), raster_.facts().width - col), std::min(block_.y(), raster_.facts().height - row)};
        if (!needed || overlap(world_bounds(window), *needed)) blocks_.push_back(window);
      }
    }
  }

  Bounds2 world_bounds(const CellWindow& w) const {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner : {Eigen::Vector2d(w.col, w.row), Eigen::Vector2d(w.col + w.width, w.row), Eigen::Vector2d(w.col, w.row + w.height),
                                          Eigen::Vector2d(w.col + w.width, w.row + w.height)})
      box.extend(raster_.world_from_cell() * corner);
    return {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
  }

  /// One cell more on each side, where the raster has one.
  CellWindow grown(const CellWindow& w) const {
    const int left = std::max(0, w.col - 1), top = std::max(0, w.row - 1);
    const int right = std::min(raster_.facts().width, w.col + w.width + 1), bottom = std::min(raster_.facts().height, w.row + w.height + 1);
    return {left, top, right - left, bottom - top};
  }

  /// Positions with a height go to the target CRS; the steps between cells become those at the middle of the grid.
  void transform_grid() {
    const std::size_t i = (grid_.height / 2) * grid_.width + grid_.width / 2;
    const Eigen::Vector2d middle(grid_.x[i], grid_.y[i]);
    std::array<Eigen::Vector3d, 3> p;
    p[0] << middle, 0;
    p[1] << middle + grid_.along, 0;
    p[2] << middle + grid_.down, 0;
    transformer_.exact().forward(p);
    grid_.along = (p[1] - p[0]).head<2>();
    grid_.down = (p[2] - p[0]).head<2>();
    transform_known(transformer_, grid_, buffer_);
  }

  void fill_grid(const CellWindow& window, const CellWindow& held) {
    grid_.resize(static_cast<std::size_t>(window.width) + 2, static_cast<std::size_t>(window.height) + 2);
    const Eigen::Affine2d& world_from_cell = raster_.world_from_cell();
    grid_.along = world_from_cell.linear().col(0);
    grid_.down = world_from_cell.linear().col(1);
    std::size_t i = 0;
    for (int row = window.row - 1; row <= window.row + window.height; ++row) {
      for (int col = window.col - 1; col <= window.col + window.width; ++col, ++i) {
        const Eigen::Vector2d p = world_from_cell * Eigen::Vector2d(col + 0.5, row + 0.5);
        grid_.x[i] = p.x();
        grid_.y[i] = p.y();
        const int held_col = col - held.col, held_row = row - held.row;
        const bool inside = held_col >= 0 && held_col < held.width && held_row >= 0 && held_row < held.height;
        grid_.z[i] = inside ? heights_[static_cast<std::size_t>(held_row) * static_cast<std::size_t>(held.width) + static_cast<std::size_t>(held_col)]
                            : std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

  RasterFile raster_;
  InterpolatedTransformer transformer_;
  Eigen::Vector2i block_;
  double cell_size_ = 0;
  int cloud_edge_ = cloud_edge;
  std::vector<CellWindow> blocks_;
  std::vector<double> heights_;
  PointGrid grid_;
  std::vector<Eigen::Vector3d> buffer_;
};

/// Cells of a square lattice of the target CRS: node (i, j) at ((i + 0.5) s, (j + 0.5) s), so that none lies on the edge of a tile.
class LatticeSampling {
 public:
  LatticeSampling(const std::filesystem::path& file, const Crs& source, const Crs& target, double spacing, const std::optional<Bounds2>& within)
      : raster_(HeightRaster::open(file, source, target)), transformer_(source, target, area_of(read_raster_facts(file), source)), spacing_(spacing) {
    block_nodes_ = static_cast<std::int64_t>(std::clamp(cloud_extent / spacing, 1.0, static_cast<double>(cloud_edge)));
    const Transformer horizontal(source.horizontal(), target.horizontal());
    const auto image = image_bounds(read_raster_facts(file).bounds, horizontal);
    if (!image && !within)
      throw CrsError(file.string() + ": reaches beyond the domain of " + target.name() + "; --bbox keeps a part of it, or --crs names another CRS");
    if (image && within)
      plan({std::max(image->outer.min_x, within->min_x), std::max(image->outer.min_y, within->min_y), std::min(image->outer.max_x, within->max_x),
            std::min(image->outer.max_y, within->max_y)});
    else
      plan(image ? image->outer : *within);
  }

  std::size_t num_blocks() const { return blocks_.size(); }
  const CoordinateOperation& operation() const { return transformer_.operation(); }
  double cell_size() const { return raster_.cell_size(); }

  void read_block(std::size_t block, const std::function<void(PointCloud&)>& visit) {
    const auto [first_i, first_j] = blocks_[block];
    grid_.resize(static_cast<std::size_t>(block_nodes_) + 2, static_cast<std::size_t>(block_nodes_) + 2);
    grid_.along = {spacing_, 0};
    grid_.down = {0, -spacing_};
    std::size_t k = 0;
    for (std::int64_t j = first_j + block_nodes_; j >= first_j - 1; --j) {
      for (std::int64_t i = first_i - 1; i <= first_i + block_nodes_; ++i, ++k) {
        grid_.x[k] = (static_cast<double>(i) + 0.5) * spacing_;
        grid_.y[k] = (static_cast<double>(j) + 0.5) * spacing_;
        grid_.z[k] = raster_.at(grid_.x[k], grid_.y[k]).value_or(std::numeric_limits<double>::quiet_NaN());
      }
    }
    PointCloud points = points_of_grid(grid_);
    if (!points.empty()) visit(points);
  }

 private:
  struct Block {
    std::int64_t i, j;   ///< of its lower left node
  };

  void plan(const Bounds2& area) {
    if (area.empty()) return;
    const double edge = static_cast<double>(block_nodes_) * spacing_;
    for (auto j = static_cast<std::int64_t>(std::floor(area.min_y / edge)); static_cast<double>(j) * edge < area.max_y; ++j)
      for (auto i = static_cast<std::int64_t>(std::floor(area.min_x / edge)); static_cast<double>(i) * edge < area.max_x; ++i)
        blocks_.push_back({i * block_nodes_, j * block_nodes_});
  }

  HeightRaster raster_;
  Transformer transformer_;
  double spacing_;
  std::int64_t block_nodes_ = cloud_edge;
  std::vector<Block> blocks_;
  PointGrid grid_;
};

using Sampling = std::variant<CellSampling, LatticeSampling>;

Sampling make_sampling(const std::filesystem::path& file, const Crs& source, const Crs& target, const RasterPointsOptions& options) {
  try {
    if (options.spacing) return LatticeSampling(file, source, target, *options.spacing, options.within);
    return CellSampling(file, source, target, options.within);
  } catch (const CrsError& error) {
    const std::string message = error.what();
    throw CrsError(message.starts_with(file.string()) ? message : file.string() + ": " + message);
  }
}

}  // namespace

struct RasterPoints::Impl {
  Sampling sampling;
};

RasterPoints::RasterPoints(const std::filesystem::path& file, const Crs& source, const Crs& target, const RasterPointsOptions& options)
    : impl_(new Impl{make_sampling(file, source, target, options)}) {}
RasterPoints::RasterPoints(const RasterPoints& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
RasterPoints& RasterPoints::operator=(const RasterPoints& other) { return *this = RasterPoints(other); }
RasterPoints::RasterPoints(RasterPoints&&) noexcept = default;
RasterPoints& RasterPoints::operator=(RasterPoints&&) noexcept = default;
RasterPoints::~RasterPoints() = default;

std::size_t RasterPoints::num_blocks() const {
  return std::visit([](const auto& sampling) { return sampling.num_blocks(); }, impl_->sampling);
}

void RasterPoints::read_block(std::size_t block, const std::function<void(PointCloud&)>& visit) {
  std::visit([&](auto& sampling) { sampling.read_block(block, visit); }, impl_->sampling);
}

double RasterPoints::cell_size() const {
  return std::visit([](const auto& sampling) { return sampling.cell_size(); }, impl_->sampling);
}

const CoordinateOperation& RasterPoints::operation() const {
  return std::visit([](const auto& sampling) -> const CoordinateOperation& { return sampling.operation(); }, impl_->sampling);
}

}  // namespace priormap
