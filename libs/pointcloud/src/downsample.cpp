#include <priormap/pointcloud/downsample.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

struct VoxelKey {
  std::int64_t x, y, z;
  bool operator==(const VoxelKey&) const = default;
};

/// Voxels of the cloud's CRS or frame, not of its origin: the same point falls into the same voxel whatever the origin.
VoxelKey voxel_of(const Eigen::Vector3d& p, double inverse_voxel) {
  return {static_cast<std::int64_t>(std::floor(p.x() * inverse_voxel)), static_cast<std::int64_t>(std::floor(p.y() * inverse_voxel)),
          static_cast<std::int64_t>(std::floor(p.z() * inverse_voxel))};
}

/// Numbers distinct voxels in order of first occurrence; open addressing, at most half full.
class VoxelIndex {
 public:
  explicit VoxelIndex(std::size_t max_voxels) {
    std::size_t capacity = 16;
    while (capacity < 2 * max_voxels) capacity *= 2;
    slots_.assign(capacity, empty_slot);
  }

  /// Number of the voxel, and whether it is new.
  std::pair<std::uint32_t, bool> insert(const VoxelKey& key) {
    for (std::size_t slot = hash(key) & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1)) {
      if (slots_[slot] == empty_slot) {
        slots_[slot] = static_cast<std::uint32_t>(keys_.size());
        keys_.push_back(key);
        return {slots_[slot], true};
      }
      if (keys_[slots_[slot]] == key) return {slots_[slot], false};
    }
  }

 private:
  static constexpr std::uint32_t empty_slot = 0xffffffffu;

  static std::size_t hash(const VoxelKey& key) {
    std::uint64_t h = static_cast<std::uint64_t>(key.x) * 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 32)) + static_cast<std::uint64_t>(key.y) * 0xc2b2ae3d27d4eb4fu;
    h = (h ^ (h >> 32)) + static_cast<std::uint64_t>(key.z) * 0x165667b19e3779f9u;
    h = (h ^ (h >> 29)) * 0xbf58476d1ce4e5b9u;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }

  std::vector<std::uint32_t> slots_;
  std::vector<VoxelKey> keys_;
};

/// Calls visit(point, voxel number, whether it is the voxel's first point) in input order.
template <class Visitor>
void for_each_in_voxels(const PointCloud& points, double voxel_m, Visitor&& visit) {
  if (!(voxel_m > 0)) throw UsageError("the voxel size must be positive");
  VoxelIndex voxels(points.size());
  const double inverse_voxel = 1.0 / voxel_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points.position(i);
    if (!p.allFinite()) continue;
    const auto [voxel, is_new] = voxels.insert(voxel_of(p, inverse_voxel));
    visit(i, voxel, is_new);
  }
}

std::vector<std::uint32_t> first_of_each_voxel(const PointCloud& points, double voxel_m) {
  std::vector<std::uint32_t> first;
  for_each_in_voxels(points, voxel_m, [&](std::size_t i, std::uint32_t, bool is_new) {
    if (is_new) first.push_back(static_cast<std::uint32_t>(i));
  });
  return first;
}

}  // namespace

PointCloud voxel_downsample_first(const PointCloud& points, double voxel_m) {
  return points.select(first_of_each_voxel(points, voxel_m));
}

PointCloud voxel_downsample_centroid(const PointCloud& points, double voxel_m) {
  std::vector<std::uint32_t> first;
  std::vector<Eigen::Vector3d> position_sum, normal_sum;
  std::vector<std::uint32_t> count;
  const bool has_normals = !points.normal.empty();
  for_each_in_voxels(points, voxel_m, [&](std::size_t i, std::uint32_t voxel, bool is_new) {
    if (is_new) {
      first.push_back(static_cast<std::uint32_t>(i));
      position_sum.push_back(Eigen::Vector3d::Zero());
      normal_sum.push_back(Eigen::Vector3d::Zero());
      count.push_back(0);
    }
    position_sum[voxel] += points.xyz[i].cast<double>();
    if (has_normals) normal_sum[voxel] += points.normal[i].cast<double>();
    ++count[voxel];
  });

  PointCloud centroids = points.select(first);
  for (std::size_t v = 0; v < first.size(); ++v) {
    centroids.xyz[v] = (position_sum[v] / count[v]).cast<float>();
    if (has_normals) centroids.normal[v] = normal_sum[v].norm() > 1e-9 ? Eigen::Vector3f(normal_sum[v].normalized().cast<float>()) : Eigen::Vector3f::Zero();
  }
  return centroids;
}

}  // namespace priormap
