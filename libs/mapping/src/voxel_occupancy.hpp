#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace priormap {

/// 8 x 8 x 8 voxels, a bit each: bit x + 8 y of word z.
struct VoxelBlock {
  Eigen::Vector3i key = Eigen::Vector3i::Zero();   ///< of its voxels, without their last three bits
  std::array<std::uint64_t, 8> bits{};
};

/// Which voxels of a grid hold something already: one bit a voxel, in blocks under a flat hash.
class VoxelOccupancy {
 public:
  explicit VoxelOccupancy(std::size_t expected_blocks = 1u << 11);

  struct Place {
    std::uint32_t block;   ///< among blocks()
    std::uint16_t bit;     ///< within the block: x + 8 y + 64 z
    bool was_free;
  };
  /// Marks a voxel.
  Place insert(const Eigen::Vector3i& voxel);
  /// Marks the voxels of a block. @return those of them that were free
  std::array<std::uint64_t, 8> insert(const VoxelBlock& block);
  /// In the order in which they were first met, until some are forgotten.
  const std::vector<VoxelBlock>& blocks() const { return blocks_; }
  std::size_t memory_bytes() const;
  /// Forgets blocks farther than `distance_m` from `center`.
  void forget_beyond(const Eigen::Vector3d& center, double distance_m, double voxel_m);

 private:
  std::uint32_t number_of(const Eigen::Vector3i& key);
  std::size_t slot_of(const Eigen::Vector3i& key) const;
  void rehash(std::size_t slots);

  std::vector<VoxelBlock> blocks_;
  std::vector<std::uint32_t> slots_;   ///< index into blocks_ + 1; 0: free
  std::uint32_t last_ = 0;             ///< block that was asked for last
};

}  // namespace priormap
