#pragma once
#include <optional>
#include <priormap/registration/surfel_map.hpp>
#include <vector>

#include "kernels.hpp"
#include "surfel_block.hpp"

namespace priormap {

/// A SurfelMap as the kernels see it; valid while the map is not changed.
class SurfelMapView {
 public:
  explicit SurfelMapView(const SurfelMap& map);

  /// The voxel whose corner float32 positions near `p` are best kept relative to.
  Eigen::Vector3i anchor_voxel(const Eigen::Vector3d& p) const;
  Eigen::Vector3d corner(const Eigen::Vector3i& voxel) const { return map_->options_.voxel_m * voxel.cast<double>(); }

  const kernels::MapView& kernel_view() const { return view_; }
  const SurfelShape& shape(std::uint32_t block, std::uint32_t entry) const { return shapes_[block][entry]; }
  std::uint32_t feature(std::uint32_t block, std::uint32_t entry) const { return map_->blocks_[block]->feature(entry); }
  /// Mean of a surfel relative to the corner of `anchor`.
  Eigen::Vector3f mean(std::uint32_t block, std::uint32_t entry, const Eigen::Vector3i& anchor) const {
    const Eigen::Vector3i offset = block_voxels * map_->index_.key(block) - anchor;
    const kernels::BlockView& means = blocks_[block];
    return offset.cast<float>() * view_.voxel_m + Eigen::Vector3f(means.x[entry], means.y[entry], means.z[entry]);
  }
  std::optional<SurfelMap::Match> nearest(const Eigen::Vector3d& query, const kernels::Table& table) const;

 private:
  const SurfelMap* map_;
  std::vector<kernels::BlockView> blocks_;
  std::vector<const SurfelShape*> shapes_;
  kernels::MapView view_;
};

}  // namespace priormap
