#include "surfel_map_view.hpp"

#include <cmath>
#include <limits>

namespace priormap {

static_assert(sizeof(Eigen::Vector3i) == 3 * sizeof(std::int32_t));

SurfelMapView::SurfelMapView(const SurfelMap& map) : map_(&map) {
  blocks_.reserve(map.blocks_.size());
  shapes_.reserve(map.blocks_.size());
  for (const auto& block : map.blocks_) {
    blocks_.push_back({block->begin(), block->x(), block->y(), block->z()});
    shapes_.push_back(block->shapes());
  }
  view_ = {map.index_.slots().data(), std::uint32_t(map.index_.slots().size() - 1), reinterpret_cast<const std::int32_t*>(map.index_.keys().data()),
           blocks_.data(), float(map.options_.voxel_m)};
}

Eigen::Vector3i SurfelMapView::anchor_voxel(const Eigen::Vector3d& p) const {
  return (p / map_->options_.voxel_m).array().floor().cast<int>();
}

std::optional<SurfelMap::Match> SurfelMapView::nearest(const Eigen::Vector3d& query, const kernels::Table& table) const {
  const Eigen::Vector3i anchor = anchor_voxel(query);
  const Eigen::Vector3f local = (query - corner(anchor)).cast<float>();
  const std::uint32_t which = 0;
  std::uint32_t block, entry;
  float squared, second;
  table.find_nearest(view_, anchor.data(), &local.x(), &local.y(), &local.z(), &which, 1, {&block, &entry, &squared, &second});
  if (block == VoxelIndex::none) return std::nullopt;
  const float none = 1e29f;
  return SurfelMap::Match{corner(anchor) + mean(block, entry, anchor).cast<double>(), shape(block, entry), std::sqrt(double(squared)),
                          second > none ? std::numeric_limits<double>::infinity() : std::sqrt(double(second))};
}

}  // namespace priormap
