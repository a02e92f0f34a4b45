#include <algorithm>
#include <cmath>
#include <priormap/core/error.hpp>
#include <priormap/registration/scan_reducer.hpp>
#include <priormap/registration/voxel_index.hpp>

namespace priormap {
namespace {

constexpr std::uint32_t empty_slot = 0xffffffffu;
constexpr float half_range = 1048576.0f;  // 2^20 voxels: 21 bits an axis

std::size_t slot_hash(std::uint64_t key) { return (key * 0x9e3779b97f4a7c15u) >> 20; }

}  // namespace

ScanReducer::ScanReducer(double voxel_m) : voxel_m_(float(voxel_m)), slots_(16384, empty_slot) {
  if (!(voxel_m > 0)) throw UsageError("scan reduction: the voxel must be above 0 m");
}

void ScanReducer::grow() {
  slots_.assign(2 * slots_.size(), empty_slot);
  const std::size_t mask = slots_.size() - 1;
  for (std::uint32_t i = 0; i < cells_.size(); ++i) {
    std::size_t slot = slot_hash(cells_[i].key) & mask;
    while (slots_[slot] != empty_slot) slot = (slot + 1) & mask;
    slots_[slot] = i;
  }
}

ScanReducer::Cell& ScanReducer::cell_of(std::uint64_t key) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = slot_hash(key) & mask;
  while (slots_[slot] != empty_slot) {
    if (cells_[slots_[slot]].key == key) return cells_[slots_[slot]];
    slot = (slot + 1) & mask;
  }
  slots_[slot] = std::uint32_t(cells_.size());
  cells_.push_back({key, 0, {0, 0, 0}, {0, 0, 0, 0, 0, 0}});
  if (2 * cells_.size() > slots_.size()) grow();
  return cells_.back();
}

SurfelCloud ScanReducer::reduce(const PointCloud& scan) {
  cells_.clear();
  std::fill(slots_.begin(), slots_.end(), empty_slot);
  const float per_metre = 1.0f / voxel_m_;
  std::uint64_t last_key = ~std::uint64_t(0);
  Cell* cell = nullptr;
  for (const Eigen::Vector3f& p : scan.xyz) {
    const Eigen::Vector3f v = p * per_metre;
    if (!(v.cwiseAbs().maxCoeff() < half_range)) continue;  // also when not a number
    // Shifted to be positive, truncation is the floor.
    const auto ix = std::uint32_t(std::int32_t(std::floor(v.x())) + 1048576);
    const auto iy = std::uint32_t(std::int32_t(std::floor(v.y())) + 1048576);
    const auto iz = std::uint32_t(std::int32_t(std::floor(v.z())) + 1048576);
    const std::uint64_t key = (std::uint64_t(ix) << 42) | (std::uint64_t(iy) << 21) | iz;
    if (key != last_key) {
      cell = &cell_of(key);
      last_key = key;
    }
    const float x = p.x() - (float(std::int32_t(ix) - 1048576) + 0.5f) * voxel_m_;
    const float y = p.y() - (float(std::int32_t(iy) - 1048576) + 0.5f) * voxel_m_;
    const float z = p.z() - (float(std::int32_t(iz) - 1048576) + 0.5f) * voxel_m_;
    cell->count += 1.0f;
    cell->sum[0] += x, cell->sum[1] += y, cell->sum[2] += z;
    cell->squares[0] += x * x, cell->squares[1] += x * y, cell->squares[2] += x * z;
    cell->squares[3] += y * y, cell->squares[4] += y * z, cell->squares[5] += z * z;
  }

  SurfelCloud out;
  out.origin = scan.origin;
  out.surfels.resize(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell& c = cells_[i];
    Surfel& s = out.surfels[i];
    const float per_point = 1.0f / c.count;
    const Eigen::Vector3f mean(c.sum[0] * per_point, c.sum[1] * per_point, c.sum[2] * per_point);
    const Eigen::Vector3f centre(float(std::int32_t(c.key >> 42) - 1048576) + 0.5f,
                                 float(std::int32_t((c.key >> 21) & 0x1fffff) - 1048576) + 0.5f,
                                 float(std::int32_t(c.key & 0x1fffff) - 1048576) + 0.5f);
    s.count = c.count;
    s.mean = centre * voxel_m_ + mean;
    s.covariance << c.squares[0] * per_point - mean.x() * mean.x(), c.squares[1] * per_point - mean.x() * mean.y(),
        c.squares[2] * per_point - mean.x() * mean.z(), c.squares[3] * per_point - mean.y() * mean.y(),
        c.squares[4] * per_point - mean.y() * mean.z(), c.squares[5] * per_point - mean.z() * mean.z();
  }
  return out;
}

SurfelCloud coarsen(const SurfelCloud& cloud, double voxel_m) {
  if (!(voxel_m > 0)) throw UsageError("scan reduction: the voxel must be above 0 m");
  SurfelCloud out;
  out.origin = cloud.origin;
  VoxelIndex index;
  const float per_metre = float(1.0 / voxel_m);
  for (const Surfel& s : cloud.surfels) {
    const std::uint32_t number = index.find_or_add((s.mean * per_metre).array().floor().cast<int>());
    if (number == out.surfels.size())
      out.surfels.push_back(s);
    else
      merge(out.surfels[number], s);
  }
  return out;
}

}  // namespace priormap
