#include "voxel_occupancy.hpp"

#include <cmath>

namespace priormap {
namespace {

std::size_t hash(const Eigen::Vector3i& key) {
  const auto part = [](int v, std::uint64_t prime) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v)) * prime; };
  const std::uint64_t h = part(key.x(), 0x9E3779B97F4A7C15u) ^ part(key.y(), 0xC2B2AE3D27D4EB4Fu) ^ part(key.z(), 0x165667B19E3779F9u);
  return static_cast<std::size_t>(h ^ (h >> 29));
}

}  // namespace

VoxelOccupancy::VoxelOccupancy(double voxel_m) : voxel_m_(voxel_m), slots_(1u << 12, 0) {}

std::size_t VoxelOccupancy::slot_of(const Eigen::Vector3i& key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(key) & mask;
  while (slots_[slot] != 0 && blocks_[slots_[slot] - 1].key != key) slot = (slot + 1) & mask;
  return slot;
}

bool VoxelOccupancy::insert(const Eigen::Vector3d& p) {
  const Eigen::Vector3i voxel = (p / voxel_m_).array().floor().cast<int>();
  const Eigen::Vector3i key = voxel.unaryExpr([](int v) { return v >> 3; });
  std::size_t slot = slot_of(key);
  if (slots_[slot] == 0) {
    if (2 * (blocks_.size() + 1) > slots_.size()) {
      rehash(2 * slots_.size());
      slot = slot_of(key);
    }
    blocks_.push_back({key, {}});
    slots_[slot] = static_cast<std::uint32_t>(blocks_.size());
  }
  std::uint64_t& word = blocks_[slots_[slot] - 1].bits[static_cast<std::size_t>(voxel.z() & 7)];
  const std::uint64_t bit = std::uint64_t{1} << ((voxel.y() & 7) * 8 + (voxel.x() & 7));
  const bool free = !(word & bit);
  word |= bit;
  return free;
}

std::size_t VoxelOccupancy::memory_bytes() const { return blocks_.capacity() * sizeof(Block) + slots_.capacity() * sizeof(slots_[0]); }

void VoxelOccupancy::forget_beyond(const Eigen::Vector3d& center, double distance_m) {
  const double block_m = 8 * voxel_m_;
  std::erase_if(blocks_, [&](const Block& block) {
    return ((block.key.cast<double>().array() + 0.5).matrix() * block_m - center).norm() > distance_m;
  });
  rehash(slots_.size());
}

void VoxelOccupancy::rehash(std::size_t slots) {
  slots_.assign(slots, 0);
  for (std::uint32_t i = 0; i < blocks_.size(); ++i) slots_[slot_of(blocks_[i].key)] = i + 1;
}

}  // namespace priormap
