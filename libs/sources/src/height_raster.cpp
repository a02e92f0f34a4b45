#include <priormap/sources/height_raster.hpp>

#include <algorithm>
#include <cmath>
#include <list>
#include <unordered_map>
#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/interpolated_transformer.hpp>

#include "raster_area.hpp"
#include "raster_file.hpp"

namespace priormap {
namespace {

constexpr int block_edge = 128;
constexpr std::size_t max_blocks = 256;  // 32 MB

/// Single cells of a raster by way of the blocks used last.
class CellCache {
 public:
  explicit CellCache(const RasterFile& raster)
      : raster_(raster), blocks_per_row_((raster.facts().width + block_edge - 1) / block_edge) {}

  /// NaN where there is no height; col and row must lie inside the raster.
  double height(int col, int row) {
    const Block& block = this->block(col / block_edge, row / block_edge);
    return block.heights[static_cast<std::size_t>(row % block_edge) * static_cast<std::size_t>(block.width) + static_cast<std::size_t>(col % block_edge)];
  }

 private:
  struct Block {
    std::int64_t key;
    int width;
    std::vector<double> heights;
  };

  const Block& block(int block_col, int block_row) {
    const std::int64_t key = static_cast<std::int64_t>(block_row) * blocks_per_row_ + block_col;
    if (!blocks_.empty() && blocks_.front().key == key) return blocks_.front();
    const auto found = by_key_.find(key);
    if (found != by_key_.end()) {
      blocks_.splice(blocks_.begin(), blocks_, found->second);
      return blocks_.front();
    }
    if (blocks_.size() == max_blocks) {
      by_key_.erase(blocks_.back().key);
      blocks_.pop_back();
    }
    blocks_.push_front(load(key, block_col, block_row));
    by_key_[key] = blocks_.begin();
    return blocks_.front();
  }

  Block load(std::int64_t key, int block_col, int block_row) const {
    const int col = block_col * block_edge, row = block_row * block_edge;
    const CellWindow window{col, row, std::min(block_edge, raster_.facts().width - col), std::min(block_edge, raster_.facts().height - row)};
    Block block{key, window.width, std::vector<double>(static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height))};
    raster_.read(window, block.heights);
    return block;
  }

  const RasterFile& raster_;
  int blocks_per_row_;
  std::list<Block> blocks_;  ///< used last first
  std::unordered_map<std::int64_t, std::list<Block>::iterator> by_key_;
};

Crs source_crs(const RasterFile& raster, const std::optional<Crs>& source) {
  if (source) return *source;
  if (raster.facts().crs) return *raster.facts().crs;
  throw CrsError(raster.path().string() + ": has no coordinate reference system; --source-crs names it");
}

template <class Call>
auto naming_file(const std::filesystem::path& file, Call&& call) {
  try {
    return call();
  } catch (const CrsError& error) {
    throw CrsError(file.string() + ": " + error.what());
  }
}

}  // namespace

struct HeightRaster::Impl {
  Impl(const std::filesystem::path& file, const std::optional<Crs>& override_crs, const Crs& target_crs)
      : raster(file, override_crs),
        source(source_crs(raster, override_crs)),
        target(target_crs),
        horizontal(naming_file(file, [&] { return target_from_raster(raster.facts(), source.horizontal(), target.horizontal()); })),
        back(horizontal, InterpolatedTransformer::Direction::inverse),
        cell_from_world(raster.world_from_cell().inverse()),
        cells(raster) {
    if (target.has_vertical()) spatial.emplace(naming_file(file, [&] { return target_from_raster(raster.facts(), source, target); }));
    if (spatial && spatial->is_identity()) spatial.reset();
  }
  Impl(const Impl& other)
      : raster(other.raster),
        source(other.source),
        target(other.target),
        horizontal(other.horizontal),
        back(other.back),
        spatial(other.spatial),
        cell_from_world(other.cell_from_world),
        cells(raster) {}

  Eigen::Vector2d cell_at(double x, double y) {
    Eigen::Vector3d p(x, y, 0);
    back.apply(std::span(&p, 1));
    return cell_from_world * p.head<2>();
  }

  /// A height of the raster at a place of the raster, as a point of the target CRS.
  Eigen::Vector3d to_target(const Eigen::Vector2d& world, double z) const {
    const Eigen::Vector3d p(world.x(), world.y(), z);
    if (spatial) return spatial->forward(p);
    if (horizontal.is_identity()) return p;
    Eigen::Vector3d moved = horizontal.forward(p);
    moved.z() = z;
    return moved;
  }

  RasterFile raster;
  Crs source, target;
  Transformer horizontal;               ///< raster to target, without heights
  InterpolatedTransformer back;         ///< target to raster, without heights
  std::optional<Transformer> spatial;   ///< with heights; none where they stay as they are
  Eigen::Affine2d cell_from_world;
  CellCache cells;
};

HeightRaster HeightRaster::open(const std::filesystem::path& file, const std::optional<Crs>& source, const Crs& target) {
  return HeightRaster(std::make_unique<Impl>(file, source, target));
}

HeightRaster::HeightRaster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HeightRaster::HeightRaster(const HeightRaster& other)
    : impl_(std::make_unique<Impl>(*other.impl_)) {}
HeightRaster& HeightRaster::operator=(const HeightRaster& other) { return *this = HeightRaster(other); }
HeightRaster::HeightRaster(HeightRaster&&) noexcept = default;
HeightRaster& HeightRaster::operator=(HeightRaster&&) noexcept = default;
HeightRaster::~HeightRaster() = default;

std::optional<double> HeightRaster::at(double x, double y) const {
  const RasterFacts& facts = impl_->raster.facts();
  const Eigen::Vector2d cell = impl_->cell_at(x, y);
  if (!(cell.x() >= 0 && cell.y() >= 0 && cell.x() <= facts.width && cell.y() <= facts.height)) return std::nullopt;

  const double col = std::clamp(cell.x() - 0.5, 0.0, facts.width - 1.0), row = std::clamp(cell.y() - 0.5, 0.0, facts.height - 1.0);
  const int col0 = static_cast<int>(col), row0 = static_cast<int>(row);
  double weight_sum = 0, height_sum = 0;
  for (int dr = 0; dr < 2; ++dr) {
    for (int dc = 0; dc < 2; ++dc) {
      const double weight = (1 - std::abs(col - col0 - dc)) * (1 - std::abs(row - row0 - dr));
      if (weight <= 0) continue;
      const double z = impl_->cells.height(col0 + dc, row0 + dr);
      if (std::isnan(z)) continue;
      weight_sum += weight;
      height_sum += weight * z;
    }
  }
  if (weight_sum < 0.5) return std::nullopt;
  const double z = height_sum / weight_sum;
  if (!impl_->spatial) return z;
  const double moved = impl_->to_target(impl_->raster.world_from_cell() * cell, z).z();
  return std::isfinite(moved) ? std::optional(moved) : std::nullopt;
}

void HeightRaster::for_each_inside(const Bounds2& bounds, const std::function<void(double, double, double)>& visit) const {
  // The window of cells around the rectangle's outline; an outline that leaves the CRS's domain gives the whole raster.
  constexpr int steps = 16;
  Eigen::AlignedBox2d outline;
  bool known = true;
  for (int i = 0; i <= steps; ++i) {
    const double x = bounds.min_x + (bounds.max_x - bounds.min_x) * i / steps, y = bounds.min_y + (bounds.max_y - bounds.min_y) * i / steps;
    for (const auto& [px, py] : {std::pair(x, bounds.min_y), std::pair(x, bounds.max_y), std::pair(bounds.min_x, y), std::pair(bounds.max_x, y)}) {
      const Eigen::Vector2d cell = impl_->cell_at(px, py);
      known = known && cell.allFinite();
      if (known) outline.extend(cell);
    }
  }
  const RasterFacts& facts = impl_->raster.facts();
  const double margin = known ? 1 + 0.01 * outline.sizes().maxCoeff() : 0;
  const auto first = [&](double v, int size) { return known ? static_cast<int>(std::clamp(std::floor(v - margin), 0.0, static_cast<double>(size))) : 0; };
  const auto last = [&](double v, int size) { return known ? static_cast<int>(std::clamp(std::ceil(v + margin), 0.0, static_cast<double>(size))) : size; };

  for (int row = first(outline.min().y(), facts.height); row < last(outline.max().y(), facts.height); ++row) {
    for (int col = first(outline.min().x(), facts.width); col < last(outline.max().x(), facts.width); ++col) {
      const double z = impl_->cells.height(col, row);
      if (std::isnan(z)) continue;
      const Eigen::Vector3d p = impl_->to_target(impl_->raster.world_from_cell() * Eigen::Vector2d(col + 0.5, row + 0.5), z);
      if (p.allFinite() && bounds.contains(p.x(), p.y())) visit(p.x(), p.y(), p.z());
    }
  }
}

ImpossibleHeights HeightRaster::impossible_heights() const { return impl_->raster.impossible_heights(); }

const Crs& HeightRaster::source() const { return impl_->source; }

double HeightRaster::cell_size() const { return target_cell_size(impl_->raster, impl_->horizontal); }

}  // namespace priormap
