#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace priormap {

/// Which voxels of a grid hold something already: one bit a voxel, in blocks of 8 x 8 x 8 under a flat hash.
class VoxelOccupancy {
 public:
  explicit VoxelOccupancy(double voxel_m);

  /// Marks the voxel of `p`. @return true when it was free
  bool insert(const Eigen::Vector3d& p);
  std::size_t memory_bytes() const;
  /// Forgets blocks farther than `distance_m` from `center`.
  void forget_beyond(const Eigen::Vector3d& center, double distance_m);

 private:
  struct Block {
    Eigen::Vector3i key;
    std::array<std::uint64_t, 8> bits;
  };
  std::size_t slot_of(const Eigen::Vector3i& key) const;
  void rehash(std::size_t slots);

  double voxel_m_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> slots_;   ///< index into blocks_ + 1; 0: free
};

}  // namespace priormap
