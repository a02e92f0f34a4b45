#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <priormap/core/error.hpp>
#include <priormap/registration/voxel_hash_map.hpp>

namespace priormap {
namespace {

/// Square of the distance from `p` to the unit box at `corner`, all in voxels.
double squared_box_distance(const Eigen::Vector3d& p, const Eigen::Vector3i& corner) {
  const Eigen::Array3d low = corner.cast<double>().array() - p.array();
  return (low.max(-low - 1.0)).max(0.0).matrix().squaredNorm();
}

}  // namespace

VoxelHashMap::VoxelHashMap(const VoxelHashMapOptions& options) : options_(options) {
  if (!(options.voxel_m > 0) || options.max_points < 1 || !(options.min_distance_m >= 0))
    throw UsageError("voxel map: the voxel must be above 0 m, the points a voxel at least 1, their distance not negative");
}

Eigen::Vector3i VoxelHashMap::key_of(const Eigen::Vector3d& p) const {
  return (p / options_.voxel_m).array().floor().cast<int>();
}

void VoxelHashMap::insert(const PointCloud& points, const Eigen::Isometry3d& T_map_points) {
  for (std::size_t i = 0; i < points.size(); ++i) insert(T_map_points * points.position(i));
}

void VoxelHashMap::insert(const Eigen::Vector3d& p_map) {
  if (!p_map.allFinite()) return;
  const Eigen::Vector3i key = key_of(p_map);
  const std::uint32_t index = index_.find_or_add(key);
  if (index == counts_.size()) {
    counts_.push_back(0);
    in_voxel_.resize(in_voxel_.size() + std::size_t(options_.max_points));
  }
  std::uint32_t& count = counts_[index];
  if (count == std::uint32_t(options_.max_points)) return;
  const Eigen::Vector3f p = (p_map - corner_of(key)).cast<float>();
  Eigen::Vector3f* const held = &in_voxel_[std::size_t(index) * std::size_t(options_.max_points)];
  const auto least = float(options_.min_distance_m * options_.min_distance_m);
  for (std::uint32_t i = 0; i < count; ++i)
    if ((held[i] - p).squaredNorm() < least) return;
  held[count++] = p;
  ++size_;
}

void VoxelHashMap::remove_beyond(const Eigen::Vector3d& center, double distance_m) {
  const auto stride = std::ptrdiff_t(options_.max_points);
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * options_.voxel_m);
  std::vector<std::uint32_t> keep;
  for (std::uint32_t i = 0; i < counts_.size(); ++i)
    if ((corner_of(index_.key(i)) + half - center).squaredNorm() <= distance_m * distance_m) keep.push_back(i);
  if (keep.size() == counts_.size()) return;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (i == keep[i]) continue;
    counts_[i] = counts_[keep[i]];
    std::copy_n(in_voxel_.begin() + std::ptrdiff_t(keep[i]) * stride, stride, in_voxel_.begin() + std::ptrdiff_t(i) * stride);
  }
  counts_.resize(keep.size());
  in_voxel_.resize(keep.size() * std::size_t(stride));
  index_.retain(keep);
  size_ = std::accumulate(counts_.begin(), counts_.end(), std::size_t(0));
}

std::optional<Neighbor> VoxelHashMap::nearest(const Eigen::Vector3d& query) const {
  if (!query.allFinite()) return std::nullopt;
  const Eigen::Vector3i center = key_of(query);
  const Eigen::Vector3d in_voxels = query / options_.voxel_m;
  const double unit = options_.voxel_m * options_.voxel_m;
  double best = std::numeric_limits<double>::infinity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();

  const auto search = [&](const Eigen::Vector3i& key) {
    if (squared_box_distance(in_voxels, key) * unit >= best) return;
    const std::uint32_t index = index_.find(key);
    if (index == VoxelIndex::none) return;
    const Eigen::Vector3d corner = corner_of(key);
    const Eigen::Vector3f local = (query - corner).cast<float>();
    const Eigen::Vector3f* const held = &in_voxel_[std::size_t(index) * std::size_t(options_.max_points)];
    for (std::uint32_t i = 0; i < counts_[index]; ++i) {
      const double d = double((held[i] - local).squaredNorm());
      if (d >= best) continue;
      best = d;
      position = corner + held[i].cast<double>();
    }
  };
  search(center);  // first, since the nearer the best so far the more voxels need no look-up
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (dx != 0 || dy != 0 || dz != 0) search(center + Eigen::Vector3i(dx, dy, dz));

  if (!std::isfinite(best)) return std::nullopt;
  return Neighbor{position, (position - query).norm()};
}

PointCloud VoxelHashMap::points(const Eigen::Vector3d& origin) const {
  PointCloud out;
  out.origin = origin;
  out.xyz.reserve(size_);
  for (std::size_t v = 0; v < counts_.size(); ++v) {
    const Eigen::Vector3d corner = corner_of(index_.key(v)) - origin;
    for (std::size_t i = 0; i < counts_[v]; ++i)
      out.xyz.push_back((corner + in_voxel_[v * std::size_t(options_.max_points) + i].cast<double>()).cast<float>());
  }
  return out;
}

}  // namespace priormap
