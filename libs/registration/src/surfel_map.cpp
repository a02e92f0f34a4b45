#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <priormap/core/error.hpp>
#include <priormap/core/symmetric.hpp>
#include <priormap/registration/surfel_map.hpp>

#include "instruction_set.hpp"
#include "surfel_block.hpp"
#include "surfel_map_view.hpp"
#include "surfel_shape.hpp"

namespace priormap {
namespace {

int floor_of(double v) {
  const auto truncated = static_cast<int>(v);
  return truncated - (v < truncated);
}

}  // namespace

SurfelMap::SurfelMap(const SurfelMapOptions& options) : options_(options) {
  if (!(options.voxel_m > 0)) throw UsageError("surfel map: the voxel must be above 0 m");
}
SurfelMap::~SurfelMap() = default;
SurfelMap::SurfelMap(SurfelMap&&) noexcept = default;
SurfelMap& SurfelMap::operator=(SurfelMap&&) noexcept = default;

SurfelMap::Item SurfelMap::place(const Eigen::Vector3d& p_map) {
  const Eigen::Vector3i voxel = (p_map / options_.voxel_m).unaryExpr(&floor_of);
  const Eigen::Vector3i key = voxel.unaryExpr([](int v) { return v >> 3; });
  const Eigen::Vector3i inside = voxel - block_voxels * key;
  Item item;
  if (last_block_ >= blocks_.size() || index_.key(last_block_) != key) last_block_ = index_.find_or_add(key);   // neighbours mostly share one
  item.block = last_block_;
  if (item.block == blocks_.size()) blocks_.push_back(std::make_unique<Block>());
  item.voxel = std::uint16_t(inside.x() + block_voxels * (inside.y() + block_voxels * inside.z()));
  item.surfel.mean = (p_map - (block_voxels * options_.voxel_m) * key.cast<double>()).cast<float>();
  return item;
}

void SurfelMap::insert(const PointCloud& points) {
  std::vector<Item> items;
  items.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points.position(i);
    if (!p.allFinite()) continue;
    Item item = place(p);
    item.surfel.count = 1;
    item.of_prior = true;
    if (!points.normal.empty() && points.normal[i].squaredNorm() > 0.25f) item.normal = points.normal[i].normalized();
    if (!points.sigma_m.empty() && std::isfinite(points.sigma_m[i])) item.sigma_m = points.sigma_m[i];
    if (!points.feature.empty()) item.feature = points.feature[i];
    items.push_back(item);
  }
  insert_items(items);
}

void SurfelMap::insert(const PatchCloud& patches) {
  std::vector<Item> items;
  items.reserve(patches.size());
  for (const SurfacePatch& patch : patches.patches) {
    Item item = place(patches.origin + patch.mean.cast<double>());
    item.surfel.count = patch.count;
    item.surfel.covariance = patch.covariance;
    item.of_prior = true;
    item.normal = patch.normal;
    item.sigma_m = patch.sigma_m;
    item.feature = patch.feature;
    items.push_back(item);
  }
  insert_items(items);
}

void SurfelMap::insert(const SurfelCloud& scan, const Eigen::Isometry3d& T_map_scan) {
  std::vector<Item> items;
  items.reserve(scan.size());
  const Eigen::Matrix3f R = T_map_scan.linear().cast<float>();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Surfel& s = scan.surfels[i];
    Item item = place(T_map_scan * (scan.origin + s.mean.cast<double>()));
    item.surfel.count = s.count;
    item.surfel.covariance = turned(s.covariance, R);
    if (!is_wide(s, float(options_.voxel_m))) item.trace = s.count * (R * cone_normal(s.mean));
    if (is_one_column(s)) item.num_in_columns = s.count;
    if (!scan.around.empty()) {
      item.around = scan.around[i];
      item.around.normal = R * item.around.normal;
    }
    items.push_back(item);
  }
  insert_items(items);
}

/// Block by block, so that each is put in order once.
void SurfelMap::insert_items(const std::vector<Item>& items) {
  std::vector<std::uint32_t> begin(blocks_.size() + 1, 0), order(items.size());
  for (const Item& item : items) ++begin[item.block + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::uint32_t i = 0; i < items.size(); ++i) order[next[items[i].block]++] = i;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (begin[b] == begin[b + 1]) continue;
    size_ -= blocks_[b]->size();
    blocks_[b]->merge(items, std::span(order).subspan(begin[b], begin[b + 1] - begin[b]), options_);
    size_ += blocks_[b]->size();
  }
}

void SurfelMap::remove_beyond(const Eigen::Vector3d& center, double distance_m) {
  const double edge = block_voxels * options_.voxel_m;
  std::vector<std::uint32_t> keep;
  for (std::uint32_t b = 0; b < blocks_.size(); ++b)
    if ((edge * (index_.key(b).cast<double>().array() + 0.5).matrix() - center).squaredNorm() <= distance_m * distance_m) keep.push_back(b);
  if (keep.size() == blocks_.size()) return;
  index_.retain(keep);
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (i != keep[i]) blocks_[i] = std::move(blocks_[keep[i]]);
  blocks_.erase(blocks_.begin() + std::ptrdiff_t(keep.size()), blocks_.end());
  size_ = 0;
  for (const auto& block : blocks_) size_ += block->size();
}

void SurfelMap::exchange(StateArchive& archive) {
  archive(index_, size_);
  if (archive.reading()) {
    blocks_.clear();
    while (blocks_.size() < index_.size()) blocks_.push_back(std::make_unique<Block>());
  }
  for (const auto& block : blocks_) block->exchange(archive, options_);
}

std::optional<SurfelMap::Match> SurfelMap::nearest(const Eigen::Vector3d& query, InstructionSet set) const {
  return SurfelMapView(*this).nearest(query, kernels_for(set));
}

PointCloud SurfelMap::points(const Eigen::Vector3d& origin) const {
  PointCloud out;
  out.origin = origin;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Eigen::Vector3d corner = (block_voxels * options_.voxel_m) * index_.key(b).cast<double>() - origin;
    const Block& block = *blocks_[b];
    for (std::size_t i = 0; i < block.size(); ++i) {
      out.xyz.push_back((corner + block.surfel(i).mean.cast<double>()).cast<float>());
      out.normal.push_back(block.shape(i).normal);
    }
  }
  return out;
}

}  // namespace priormap
