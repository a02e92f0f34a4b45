#include "voxel_occupancy.hpp"

#include <bit>

namespace priormap {
namespace {

std::size_t hash(const Eigen::Vector3i& key) {
  const auto part = [](int v, std::uint64_t prime) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v)) * prime; };
  const std::uint64_t h = part(key.x(), 0x9E3779B97F4A7C15u) ^ part(key.y(), 0xC2B2AE3D27D4EB4Fu) ^ part(key.z(), 0x165667B19E3779F9u);
  return static_cast<std::size_t>(h ^ (h >> 29));
}

}  // namespace

VoxelOccupancy::VoxelOccupancy(std::size_t expected_blocks) : slots_(std::bit_ceil(2 * expected_blocks), 0) { blocks_.reserve(expected_blocks); }

std::size_t VoxelOccupancy::slot_of(const Eigen::Vector3i& key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(key) & mask;
  while (slots_[slot] != 0 && blocks_[slots_[slot] - 1].key != key) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t VoxelOccupancy::number_of(const Eigen::Vector3i& key) {
  if (last_ < blocks_.size() && blocks_[last_].key == key) return last_;
  std::size_t slot = slot_of(key);
  if (slots_[slot] == 0) {
    if (2 * (blocks_.size() + 1) > slots_.size()) {
      rehash(2 * slots_.size());
      slot = slot_of(key);
    }
    blocks_.push_back({key, {}});
    slots_[slot] = static_cast<std::uint32_t>(blocks_.size());
  }
  return last_ = slots_[slot] - 1;
}

VoxelOccupancy::Place VoxelOccupancy::insert(const Eigen::Vector3i& voxel) {
  const std::uint32_t number = number_of({voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3});
  const int bit = (voxel.x() & 7) + 8 * (voxel.y() & 7), layer = voxel.z() & 7;
  std::uint64_t& word = blocks_[number].bits[static_cast<std::size_t>(layer)];
  const bool was_free = !(word >> bit & 1);
  word |= std::uint64_t{1} << bit;
  return {number, static_cast<std::uint16_t>(bit + 64 * layer), was_free};
}

std::array<std::uint64_t, 8> VoxelOccupancy::insert(const VoxelBlock& block) {
  std::array<std::uint64_t, 8>& bits = blocks_[number_of(block.key)].bits;
  std::array<std::uint64_t, 8> free;
  for (std::size_t z = 0; z < bits.size(); ++z) {
    free[z] = block.bits[z] & ~bits[z];
    bits[z] |= block.bits[z];
  }
  return free;
}

std::size_t VoxelOccupancy::memory_bytes() const { return blocks_.capacity() * sizeof(VoxelBlock) + slots_.capacity() * sizeof(slots_[0]); }

void VoxelOccupancy::forget_beyond(const Eigen::Vector3d& center, double distance_m, double voxel_m) {
  const double block_m = 8 * voxel_m;
  std::erase_if(blocks_, [&](const VoxelBlock& block) {
    return ((block.key.cast<double>().array() + 0.5).matrix() * block_m - center).norm() > distance_m;
  });
  rehash(slots_.size());
}

void VoxelOccupancy::rehash(std::size_t slots) {
  slots_.assign(slots, 0);
  for (std::uint32_t i = 0; i < blocks_.size(); ++i) slots_[slot_of(blocks_[i].key)] = i + 1;
}

}  // namespace priormap
